'use strict';
// Plays a recording written by ReplayRecorder (its layout stands in src/io/replay.cpp).
(async () => {
const $ = id => document.getElementById(id);
const root = document.documentElement;

// ---- reading the recording ---------------------------------------------------------------------------------------

async function inflate(text) {
  const packed = atob(text.trim());
  const bytes = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; ++i) bytes[i] = packed.charCodeAt(i);
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip')).getReader();
  const chunks = [];
  let size = 0;
  try {
    for (;;) {
      const {done, value} = await reader.read();
      if (done) break;
      chunks.push(value);
      size += value.length;
    }
  } catch (error) {
    // a run that was killed leaves no end: what is there is shown
    if (size === 0) throw error;
  }
  const all = new Uint8Array(size);
  let at = 0;
  for (const chunk of chunks) { all.set(chunk, at); at += chunk.length; }
  return all;
}

class Reader {
  constructor(bytes) { this.bytes = bytes; this.at = 0; }
  byte() {
    if (this.at >= this.bytes.length) throw new RangeError('end of recording');
    return this.bytes[this.at++];
  }
  count() {
    let value = 0, scale = 1;
    for (;;) {
      const byte = this.byte();
      value += (byte & 127) * scale;
      if (byte < 128) return value;
      scale *= 128;
    }
  }
  signed() { const value = this.count(); return value % 2 ? -(value + 1) / 2 : value / 2; }
  text() {
    const size = this.count();
    if (this.at + size > this.bytes.length) throw new RangeError('end of recording');
    this.at += size;
    return new TextDecoder().decode(this.bytes.subarray(this.at - size, this.at));
  }
}

const kTurn = 2 * Math.PI / 4096;

function decode(bytes) {
  const reader = new Reader(bytes);
  if (String.fromCharCode(...bytes.subarray(0, 4)) !== 'SGR1') throw new Error('not a recording');
  reader.at = 4;
  const recording = {map: JSON.parse(reader.text()), times: [], agents: [], signals: [], events: []};
  let alive = [], time = 0;
  const readAgent = first => {
    const agent = {id: reader.count(), type: reader.byte(), external: reader.byte() === 1, name: reader.text(), first,
      outline: [], x: [], y: [], h: [], why: [], at: [0, 0, 0, 0, 0]};
    for (let corners = reader.byte(); corners > 0; --corners) agent.outline.push([reader.signed() / 100, reader.signed() / 100]);
    return agent;
  };
  const readStep = () => {
    const elapsed = reader.count();
    let index = 0;
    const gone = new Set();
    for (let n = reader.count(); n > 0; --n) { index += reader.count(); gone.add(index); }
    if (gone.size) alive = alive.filter((_, i) => !gone.has(i));
    const step = recording.times.length;
    for (let n = reader.count(); n > 0; --n) {
      const agent = readAgent(step);
      recording.agents.push(agent);
      alive.push(agent);
    }
    for (const agent of alive) {
      const at = agent.at;
      at[2] += reader.signed(); at[3] += reader.signed();
      at[0] += at[2]; at[1] += at[3];
      at[4] += reader.signed();
      const why = reader.byte();
      agent.x.push(at[0] / 100); agent.y.push(at[1] / 100); agent.h.push(at[4] * kTurn); agent.why.push(why);
    }
    time += elapsed / 1000;
    recording.times.push(time);
  };
  const readSignals = () => {
    for (let n = reader.count(); n > 0; --n) {
      const signal = reader.count();
      (recording.signals[signal] ||= []).push({step: recording.times.length, state: reader.text()});
    }
  };
  const readEvent = () => {
    const kind = reader.byte(), ms = reader.count();
    recording.events.push({kind, time: ms / 1000, x: reader.signed() / 100, y: reader.signed() / 100,
      a: reader.count(), b: reader.count() - 1});
  };
  try {
    for (;;) {
      const record = reader.byte();
      if (record === 0) break;
      if (record === 1) readStep();
      else if (record === 2) readSignals();
      else if (record === 3) readEvent();
      else throw new Error('unknown record ' + record);
    }
  } catch (error) {
    if (!(error instanceof RangeError)) throw error;
  }
  finish(recording);
  return recording;
}

/// Typed arrays, sizes and names by id.
function finish(recording) {
  const byId = new Map();
  for (const agent of recording.agents) {
    agent.length = Math.min(agent.x.length, agent.y.length, agent.h.length, agent.why.length);
    agent.x = Float64Array.from(agent.x); agent.y = Float64Array.from(agent.y);
    agent.h = Float32Array.from(agent.h); agent.why = Uint8Array.from(agent.why);
    const xs = agent.outline.map(p => p[0]), ys = agent.outline.map(p => p[1]);
    agent.front = Math.max(...xs); agent.back = Math.min(...xs);
    agent.left = Math.max(...ys); agent.right = Math.min(...ys);
    agent.box = agent.outline.length === 4;
    byId.set(agent.id, agent);
  }
  recording.agents = recording.agents.filter(agent => agent.length > 0);
  recording.byId = byId;
  recording.alive = new Uint32Array(recording.times.length);
  for (const agent of recording.agents)
    for (let k = 0; k < agent.length; ++k) ++recording.alive[agent.first + k];
  recording.events.sort((a, b) => a.time - b.time);
}

let recording;
try {
  recording = decode(await inflate($('data').textContent));
  $('data').remove();
} catch (error) {
  $('notice').textContent = 'This page holds no readable recording: ' + error.message;
  root.dataset.state = 'error';
  return;
}
const {map, times, agents, events} = recording;
const begin = times.length ? times[0] : 0, end = times.length ? times[times.length - 1] : 0;

// ---- looks -------------------------------------------------------------------------------------------------------

const kTypeColours = {
  car: '#4d9fec', van: '#8a78f2', bus: '#f2c037', truck: '#b5835a', motorcycle: '#ec5aa5', bicycle: '#3ccb8f',
  pedestrian: '#ff8a3d', electric_tricycle: '#b6d23c', gyro_scooter: '#43d3df',
};
const kSpareColours = ['#d7dde4', '#e36d6d', '#7fb069', '#a0c4ff', '#e0aaff'];
const kReasons = ['nothing', 'signal', 'yield', 'crossing', 'blocked junction', 'leader', 'stop', 'end of path'];
const kReasonColours = ['#3ccb8f', '#f2545b', '#f2c037', '#ff8a3d', '#b070ff', '#4d9fec', '#9aa5b1', '#d7dde4'];
const kEventNames = ['collision', 'red light run', 'stuck'];
const kEventPlurals = ['collisions', 'red lights run', 'stuck'];
const kEventColours = ['#ff3b47', '#ff9f1a', '#b070ff'];
const typeColour = map.types.map((type, i) => kTypeColours[type.name] || kSpareColours[i % kSpareColours.length]);
const hidden = new Set();
let css = {};

function readTheme() {
  const style = getComputedStyle(root);
  for (const name of ['ground', 'road', 'walk', 'area', 'cycle', 'rail', 'building', 'wall', 'mark', 'middle', 'zebra', 'bridge',
    'text', 'dim', 'accent', 'outline', 'glass', 'halo', 'line']) css[name] = style.getPropertyValue('--' + name).trim();
}

function speedColour(speed) {
  const share = Math.min(speed / 14, 1);
  return `hsl(${Math.round(4 + 140 * share)} 78% ${Math.round(58 - 8 * share)}%)`;
}

// ---- the map as paths, by level and look -------------------------------------------------------------------------

const kLook = {road: 0, walk: 1, cycle: 2, rail: 3, inside: 4, crossing: 5, area: 6};
const layers = new Map();  // level -> look -> width -> Path2D
const bounds = {left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity};

function include(x, y) {
  bounds.left = Math.min(bounds.left, x); bounds.right = Math.max(bounds.right, x);
  bounds.bottom = Math.min(bounds.bottom, y); bounds.top = Math.max(bounds.top, y);
}

function pathOf(level, look, width) {
  if (!layers.has(level)) layers.set(level, new Map());
  const looks = layers.get(level);
  if (!looks.has(look)) looks.set(look, new Map());
  const widths = looks.get(look);
  if (!widths.has(width)) widths.set(width, new Path2D());
  return widths.get(width);
}

function trace(path, points, closed) {
  for (let i = 0; i < points.length; i += 2) {
    const x = points[i] / 10, y = points[i + 1] / 10;
    if (i === 0) path.moveTo(x, y); else path.lineTo(x, y);
  }
  if (closed) path.closePath();
}

/// The chain moved sideways, positive to the left.
function traceBeside(path, points, offset) {
  const count = points.length / 2;
  for (let i = 0; i < count; ++i) {
    const a = Math.max(i - 1, 0) * 2, b = Math.min(i + 1, count - 1) * 2;
    const dx = points[b] - points[a], dy = points[b + 1] - points[a + 1], norm = Math.hypot(dx, dy) || 1;
    const x = points[2 * i] / 10 - dy / norm * offset, y = points[2 * i + 1] / 10 + dx / norm * offset;
    if (i === 0) path.moveTo(x, y); else path.lineTo(x, y);
  }
}

const junctions = new Path2D(), buildings = new Path2D(), walls = new Path2D();
function buildMap() {
  for (const lane of map.lanes) {
    const level = lane.z || 0;
    for (let i = 0; i < lane.p.length; i += 2) include(lane.p[i] / 10, lane.p[i + 1] / 10);
    const path = pathOf(level, lane.k, lane.k === kLook.area ? 0 : lane.w / 10);
    trace(path, lane.p, lane.k === kLook.area);
    if (lane.m) traceBeside(pathOf(level, lane.m === 1 ? 'dashed' : 'middle', 0), lane.p, (lane.l ? -1 : 1) * lane.w / 20);
  }
  for (const ring of map.junctions) trace(junctions, ring, true);
  for (const obstacle of map.obstacles) {
    if (obstacle.k === 0) trace(buildings, obstacle.p, true); else trace(walls, obstacle.p, false);
  }
  for (const agent of agents) {
    include(agent.x[0], agent.y[0]);
    include(agent.x[agent.length - 1], agent.y[agent.length - 1]);
  }
  if (bounds.left > bounds.right) Object.assign(bounds, {left: -50, right: 50, bottom: -50, top: 50});
}

function drawLevel(ctx, level, scale) {
  const looks = layers.get(level);
  const stroke = (look, colour, grow = 0) => {
    for (const [width, path] of looks.get(look) || []) {
      ctx.strokeStyle = colour;
      ctx.lineWidth = Math.max(width + grow, 0.8 / scale);
      ctx.stroke(path);
    }
  };
  ctx.lineCap = 'butt';
  ctx.lineJoin = 'round';
  if (level > 0) for (const look of [kLook.walk, kLook.cycle, kLook.road, kLook.inside]) stroke(look, css.bridge, 0.9);
  if (looks.has(kLook.area)) {
    ctx.fillStyle = ctx.strokeStyle = css.area;
    ctx.lineWidth = 0.12;
    ctx.fill(looks.get(kLook.area).get(0)); ctx.stroke(looks.get(kLook.area).get(0));
  }
  stroke(kLook.rail, css.rail);
  stroke(kLook.walk, css.walk, 0.02);
  stroke(kLook.cycle, css.cycle, 0.02);
  stroke(kLook.road, css.road, 0.06);
  if (level !== 0 || !map.junctions.length) stroke(kLook.inside, css.road, 0.06);
  if (scale < 1.2) return;
  ctx.setLineDash([0.5, 0.5]);
  stroke(kLook.crossing, css.zebra);
  if (scale > 2) {
    ctx.setLineDash([3, 4.5]);
    if (looks.has('dashed')) { ctx.strokeStyle = css.mark; ctx.lineWidth = 0.13; ctx.stroke(looks.get('dashed').get(0)); }
    ctx.setLineDash([]);
    if (looks.has('middle')) { ctx.strokeStyle = css.middle; ctx.lineWidth = 0.14; ctx.stroke(looks.get('middle').get(0)); }
  }
  ctx.setLineDash([]);
}

function drawMap(ctx, scale) {
  ctx.fillStyle = css.building; ctx.fill(buildings);
  ctx.strokeStyle = css.wall; ctx.lineWidth = Math.max(0.25, 0.7 / scale); ctx.stroke(buildings);
  ctx.lineWidth = Math.max(0.3, 1 / scale); ctx.stroke(walls);
  const levels = [...layers.keys()].sort((a, b) => a - b);
  for (const level of levels) {
    ctx.globalAlpha = level < 0 ? 0.45 : 1;
    // junction grounds lie under the lanes of the ground level
    if (level === 0) {
      ctx.fillStyle = ctx.strokeStyle = css.road;
      ctx.lineWidth = 0.12;  // no hairlines between grounds that touch
      ctx.fill(junctions); ctx.stroke(junctions);
    }
    drawLevel(ctx, level, scale);
  }
  ctx.globalAlpha = 1;
}

// ---- view --------------------------------------------------------------------------------------------------------

const canvas = $('view'), screen = canvas.getContext('2d', {alpha: false});
const view = {x: 0, y: 0, scale: 1};
let width = 0, height = 0, dpr = 1, dirty = true;
const still = {canvas: document.createElement('canvas'), x: 0, y: 0, scale: 0, valid: false, drawn: 0, cost: 0};

const toScreenX = x => (x - view.x) * view.scale + width / 2;
const toScreenY = y => height / 2 - (y - view.y) * view.scale;
const toWorldX = px => (px - width / 2) / view.scale + view.x;
const toWorldY = py => (height / 2 - py) / view.scale + view.y;

function resize() {
  dpr = window.devicePixelRatio || 1;
  width = window.innerWidth; height = window.innerHeight;
  canvas.width = Math.round(width * dpr); canvas.height = Math.round(height * dpr);
  still.valid = false;
  drawTimeline();
  dirty = true;
}

function fit(box) {
  const pad = 60;
  view.x = (box.left + box.right) / 2; view.y = (box.bottom + box.top) / 2;
  view.scale = Math.min((width - pad) / Math.max(box.right - box.left, 10), (height - 2 * pad) / Math.max(box.top - box.bottom, 10));
  dirty = true;
}

/// Where most of the traffic is: the whole map may be far larger.
function busyBox() {
  const xs = [], ys = [];
  const every = Math.max(1, Math.floor(agents.reduce((sum, agent) => sum + agent.length, 0) / 20000));
  for (const agent of agents) for (let k = 0; k < agent.length; k += every) { xs.push(agent.x[k]); ys.push(agent.y[k]); }
  if (!xs.length) return bounds;
  xs.sort((a, b) => a - b); ys.sort((a, b) => a - b);
  const at = (list, share) => list[Math.floor(share * (list.length - 1))];
  return {left: at(xs, .15) - 15, right: at(xs, .85) + 15, bottom: at(ys, .15) - 15, top: at(ys, .85) + 15};
}

/// The map is drawn once into a larger picture, which is then moved; a new one is drawn when the view has left it.
function drawStill(now) {
  const margin = 1.5;
  const far = Math.abs(view.x - still.x) * view.scale > width * (margin - 1) / 2 ||
              Math.abs(view.y - still.y) * view.scale > height * (margin - 1) / 2;
  const stale = !still.valid || far || view.scale !== still.scale;
  const patient = still.valid && still.cost > 20 && now - still.drawn < 120 && now - view.changed < 120;
  if (stale && !patient) {
    const started = performance.now();
    const w = Math.round(width * margin * dpr), h = Math.round(height * margin * dpr);
    if (still.canvas.width !== w || still.canvas.height !== h) { still.canvas.width = w; still.canvas.height = h; }
    const ctx = still.canvas.getContext('2d', {alpha: false});
    ctx.setTransform(1, 0, 0, 1, 0, 0);
    ctx.fillStyle = css.ground;
    ctx.fillRect(0, 0, w, h);
    const s = view.scale * dpr;
    ctx.setTransform(s, 0, 0, -s, w / 2 - view.x * s, h / 2 + view.y * s);
    drawMap(ctx, view.scale);
    Object.assign(still, {x: view.x, y: view.y, scale: view.scale, valid: true, drawn: now, cost: performance.now() - started});
  } else if (stale) {
    dirty = true;
  }
  const zoom = view.scale / still.scale;
  const w = still.canvas.width * zoom, h = still.canvas.height * zoom;
  screen.setTransform(1, 0, 0, 1, 0, 0);
  screen.fillStyle = css.ground;
  screen.fillRect(0, 0, canvas.width, canvas.height);
  screen.drawImage(still.canvas, canvas.width / 2 + (still.x - view.x) * view.scale * dpr - w / 2,
    canvas.height / 2 - (still.y - view.y) * view.scale * dpr - h / 2, w, h);
}

// ---- time --------------------------------------------------------------------------------------------------------

let time = begin, playing = false, rate = 1, followed = null, hovered = null, paint = 'type', trails = false;

/// Index of the last step at or before t.
function stepAt(t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t + 1e-9) low = middle; else high = middle - 1;
  }
  return low;
}

const pose = {x: 0, y: 0, h: 0, speed: 0, slowing: false, why: 0};
/// Pose of an agent between two steps; false where it isn't alive.
function poseAt(agent, step, share) {
  const k = step - agent.first;
  if (k < 0 || k >= agent.length) return false;
  const next = Math.min(k + 1, agent.length - 1);
  pose.x = agent.x[k] + (agent.x[next] - agent.x[k]) * share;
  pose.y = agent.y[k] + (agent.y[next] - agent.y[k]) * share;
  pose.h = agent.h[k] + (agent.h[next] - agent.h[k]) * share;
  pose.why = agent.why[k];
  const speedOver = (a, b) => {
    a = Math.max(a, 0); b = Math.min(b, agent.length - 1);
    return b > a ? Math.hypot(agent.x[b] - agent.x[a], agent.y[b] - agent.y[a]) / (times[agent.first + b] - times[agent.first + a]) : 0;
  };
  pose.speed = speedOver(k - 1, k + 1);
  pose.slowing = speedOver(k - 1, k + 2) < speedOver(k - 5, k - 2) - 0.3 || pose.speed < 0.15;
  return true;
}

// ---- drawing the moving parts ------------------------------------------------------------------------------------

const kLights = {G: '#35d06b', g: '#35d06b', y: '#ffc53d', Y: '#ffc53d', r: '#ff4550', u: '#ff8c42', s: '#35d06b'};
const cursors = [];

function signalState(signal, step) {
  const changes = recording.signals[signal];
  if (!changes || changes[0].step > step) return '';
  let at = cursors[signal] || 0;
  if (changes[at].step > step) at = 0;
  while (at + 1 < changes.length && changes[at + 1].step <= step) ++at;
  cursors[signal] = at;
  return changes[at].state;
}

function drawSignals(step) {
  if (view.scale < 0.7) return;
  screen.lineCap = 'butt';
  screen.lineWidth = Math.max(0.45 * view.scale, 2.2) ;
  for (const [px, py, heading, half, links] of map.stopLines) {
    const x = px / 10, y = py / 10, sx = toScreenX(x), sy = toScreenY(y);
    if (sx < -40 || sy < -40 || sx > width + 40 || sy > height + 40) continue;
    const count = links.length / 2, w = 2 * half / 10 * 0.92 / count;
    // left of the direction of travel, on a screen whose y points down
    const lx = -Math.sin(heading / 1000), ly = -Math.cos(heading / 1000);
    for (let i = 0; i < count; ++i) {
      const state = signalState(links[2 * i], step);
      screen.strokeStyle = kLights[state[links[2 * i + 1]]] || '#8a949e';
      const from = (-half / 10 * 0.92 + i * w) * view.scale, to = from + w * 0.94 * view.scale;
      screen.beginPath();
      screen.moveTo(sx + lx * from, sy + ly * from);
      screen.lineTo(sx + lx * to, sy + ly * to);
      screen.stroke();
    }
  }
}

function colourOf(agent) {
  if (paint === 'speed') return speedColour(pose.speed);
  if (paint === 'reason') return pose.why & 16 ? kReasonColours[pose.why & 15] : '#7d8791';
  return typeColour[agent.type];
}

function outlinePath(agent) {
  screen.beginPath();
  if (agent.box) {
    const l = agent.front - agent.back, w = agent.left - agent.right;
    const r = Math.min(0.32 * w, 0.45);
    screen.roundRect(agent.back, agent.right, l, w, r);
    return;
  }
  agent.outline.forEach(([x, y], i) => i ? screen.lineTo(x, y) : screen.moveTo(x, y));
  screen.closePath();
}

function drawWalker(agent) {
  const w = agent.left - agent.right, l = agent.front - agent.back;
  screen.beginPath();
  screen.ellipse(0, 0, l / 2, w / 2, 0, 0, 2 * Math.PI);
  screen.fill(); screen.stroke();
  screen.fillStyle = css.glass;
  screen.beginPath();
  screen.arc(0.06 * l, 0, 0.27 * w, 0, 2 * Math.PI);
  screen.fill();
}

function drawTwoWheeler(agent) {
  const w = agent.left - agent.right, l = agent.front - agent.back;
  screen.globalAlpha = 0.5;
  outlinePath(agent); screen.fill();
  screen.globalAlpha = 1;
  screen.beginPath();
  screen.roundRect(agent.back, -0.13 * w, l, 0.26 * w, 0.12 * w);
  screen.fill(); screen.stroke();
  screen.beginPath();
  screen.ellipse(agent.back + 0.42 * l, 0, 0.14 * l, 0.38 * w, 0, 0, 2 * Math.PI);
  screen.fill(); screen.stroke();
  screen.fillStyle = css.glass;
  screen.beginPath();
  screen.arc(agent.back + 0.45 * l, 0, 0.2 * w, 0, 2 * Math.PI);
  screen.fill();
}

function drawCar(agent, name, detailed) {
  const w = agent.left - agent.right, l = agent.front - agent.back;
  outlinePath(agent);
  screen.fill(); screen.stroke();
  screen.fillStyle = css.glass;
  const band = (from, to, inset, taper) => {
    screen.beginPath();
    screen.moveTo(agent.front - from, w / 2 - inset - taper); screen.lineTo(agent.front - from, -w / 2 + inset + taper);
    screen.lineTo(agent.front - to, -w / 2 + inset); screen.lineTo(agent.front - to, w / 2 - inset);
    screen.closePath(); screen.fill();
  };
  if (name === 'bus') {
    band(0.25, 1.0, 0.2, 0);
    if (detailed) { screen.globalAlpha = 0.22; for (let x = 2.2; x < l - 1.2; x += 2.6) band(x, x + 1.5, 0.42, 0); }
  } else if (name === 'truck') {
    band(0.2, 0.8, 0.25, 0.05);
    band(1.9, 2.12, 0, 0);
  } else {
    // bonnet, windscreen, roof, rear window
    band(0.22 * l, 0.36 * l, 0.14 * w, 0.05 * w);
    if (detailed) band(l - 0.06 * l, l - 0.17 * l, 0.16 * w, 0.05 * w);
  }
  screen.globalAlpha = 1;
  if (detailed && pose.slowing) {
    screen.fillStyle = '#ff2d3a';
    const size = Math.min(0.16 * w, 0.35);
    screen.fillRect(agent.back, w / 2 - 0.34 * w, 0.18, size);
    screen.fillRect(agent.back, -w / 2 + 0.34 * w - size, 0.18, size);
  }
}

const kTwoWheelers = new Set(['bicycle', 'motorcycle', 'electric_tricycle', 'gyro_scooter']);

function drawAgent(agent) {
  const sx = toScreenX(pose.x), sy = toScreenY(pose.y);
  if (sx < -80 || sy < -80 || sx > width + 80 || sy > height + 80) return;
  const type = map.types[agent.type];
  const l = agent.front - agent.back;
  const colour = colourOf(agent);
  // small bodies stay visible from afar
  const w = agent.left - agent.right;
  const s = Math.max(view.scale, (type.walks ? 4.8 : 8) / Math.max(l, 0.4), (type.walks ? 4.8 : 3.6) / Math.max(w, 0.4));
  const cos = Math.cos(pose.h) * s * dpr, sin = Math.sin(pose.h) * s * dpr;
  screen.setTransform(cos, -sin, -sin, -cos, sx * dpr, sy * dpr);
  screen.fillStyle = colour;
  screen.strokeStyle = agent.external ? css.halo : css.outline;
  screen.lineWidth = (agent.external ? 1.4 : 0.8) / s;
  if (s * l < 5.5) {
    screen.beginPath();
    screen.arc(0, 0, 2.4 / s, 0, 2 * Math.PI);
    screen.fill(); screen.stroke();
  } else if (type.walks) {
    drawWalker(agent);
  } else if (kTwoWheelers.has(type.name) && s * l > 16) {
    drawTwoWheeler(agent);
  } else {
    drawCar(agent, type.name, s > 5);
  }
  if (agent === followed || agent === hovered) {
    screen.setTransform(dpr, 0, 0, dpr, 0, 0);
    screen.strokeStyle = agent === followed ? css.accent : css.halo;
    screen.lineWidth = 2;
    screen.beginPath();
    screen.arc(sx, sy, Math.max(l * view.scale * 0.75, 11), 0, 2 * Math.PI);
    screen.stroke();
  }
}

function drawTrail(agent, step, colour) {
  const last = Math.min(step - agent.first, agent.length - 1);
  if (last < 1) return;
  const seconds = 10;
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  screen.strokeStyle = colour;
  screen.lineWidth = Math.max(1.5, Math.min(0.35 * view.scale, 4));
  screen.lineJoin = screen.lineCap = 'round';
  screen.globalAlpha = 0.55;
  screen.beginPath();
  for (let k = last; k >= 0 && times[step] - times[agent.first + k] <= seconds; --k) {
    const x = toScreenX(agent.x[k]), y = toScreenY(agent.y[k]);
    if (k === last) screen.moveTo(x, y); else screen.lineTo(x, y);
  }
  screen.stroke();
  screen.globalAlpha = 1;
}

function drawEvents() {
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  const shown = 2.5;
  for (const event of events) {
    const age = time - event.time;
    if (age < -0.05 || age > shown) continue;
    const share = Math.max(age, 0) / shown, x = toScreenX(event.x), y = toScreenY(event.y);
    screen.strokeStyle = kEventColours[event.kind];
    screen.globalAlpha = 1 - share;
    screen.lineWidth = 3;
    screen.beginPath();
    screen.arc(x, y, 10 + 26 * share, 0, 2 * Math.PI);
    screen.stroke();
  }
  screen.globalAlpha = 1;
}

function drawScaleBar() {
  const steps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
  const metres = steps.find(m => m * view.scale > 60) || 10000;
  const length = metres * view.scale, x = width - 24 - length, y = height - 82;
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  screen.strokeStyle = screen.fillStyle = css.dim;
  screen.lineWidth = 1.5;
  screen.beginPath();
  screen.moveTo(x, y - 5); screen.lineTo(x, y); screen.lineTo(x + length, y); screen.lineTo(x + length, y - 5);
  screen.stroke();
  screen.font = '11px system-ui, sans-serif';
  screen.textAlign = 'right';
  screen.fillText(metres >= 1000 ? metres / 1000 + ' km' : metres + ' m', x + length - 4, y - 6);
}

const counts = new Uint32Array(map.types.length);
function drawScene(now) {
  const step = stepAt(time);
  const next = Math.min(step + 1, times.length - 1);
  const share = next > step ? Math.min(Math.max((time - times[step]) / (times[next] - times[step]), 0), 1) : 0;
  if (followed && poseAt(followed, step, share)) { view.x = pose.x; view.y = pose.y; }
  drawStill(now);
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  drawSignals(step);
  counts.fill(0);
  let byGamma = 0, alive = 0;
  if (trails) for (const agent of agents) if (!hidden.has(agent.type) && poseAt(agent, step, share)) drawTrail(agent, step, colourOf(agent));
  if (followed && !trails) drawTrail(followed, step, css.accent);
  // people on foot last: they are small
  for (const walks of [false, true])
    for (const agent of agents) {
      if (map.types[agent.type].walks !== walks || !poseAt(agent, step, share)) continue;
      ++counts[agent.type]; ++alive;
      if (!agent.external) ++byGamma;
      if (!hidden.has(agent.type)) drawAgent(agent);
    }
  drawEvents();
  drawScaleBar();
  showState(step, share, alive, byGamma);
}

// ---- panels ------------------------------------------------------------------------------------------------------

const clockText = t => {
  const tenths = Math.round(t * 10), minutes = Math.floor(tenths / 600);
  return minutes + ':' + ((tenths % 600) / 10).toFixed(1).padStart(4, '0');
};
const spoken = name => name.replaceAll('_', ' ');

let legendFor = '';
function buildLegend() {
  const list = $('legend');
  list.textContent = '';
  legendFor = paint;
  const item = (colour, text, key, round) => {
    const li = document.createElement('li'), mark = document.createElement('i'), label = document.createElement('span'), count = document.createElement('b');
    mark.style.background = colour;
    if (round) mark.className = 'round';
    label.textContent = text;
    li.append(mark, label, count);
    list.append(li);
    if (key !== undefined) {
      li.dataset.type = key;
      li.title = 'show or hide';
      li.onclick = () => { hidden.has(key) ? hidden.delete(key) : hidden.add(key); li.classList.toggle('off'); dirty = true; };
      if (hidden.has(key)) li.classList.add('off');
    }
  };
  if (paint === 'type') {
    const present = new Set(agents.map(agent => agent.type));
    map.types.forEach((type, i) => { if (present.has(i)) item(typeColour[i], spoken(type.name), i, type.walks); });
  } else if (paint === 'reason') {
    const present = new Set();
    for (const agent of agents) for (let k = 0; k < agent.length; k += 5) if (agent.why[k] & 16) present.add(agent.why[k] & 15);
    kReasons.forEach((name, i) => { if (present.has(i)) item(kReasonColours[i], i ? name : 'free'); });
    if (!present.size) item('#7d8791', 'not known');
  } else {
    const li = document.createElement('li'), bar = document.createElement('div');
    bar.className = 'scale';
    bar.style.background = `linear-gradient(90deg, ${[0, 3.5, 7, 10.5, 14].map(speedColour).join(',')})`;
    li.append(bar);
    const ends = document.createElement('li');
    ends.className = 'ends';
    ends.innerHTML = '<span>standing</span><b>50 km/h</b>';
    list.append(li, ends);
  }
}

function buildMarks() {
  const lines = [0, 1, 2].map(kind => [kind, events.filter(event => event.kind === kind).length]).filter(([, n]) => n > 0);
  for (const [kind, n] of lines) {
    const link = document.createElement('a'), count = document.createElement('em');
    count.textContent = n + ' ';
    count.style.color = kEventColours[kind];
    link.append(count, n === 1 ? kEventNames[kind] : kEventPlurals[kind], ' ›');
    link.title = 'go to the next one';
    link.onclick = () => nextEvent(kind);
    $('marks').append(link);
  }
}

function nextEvent(kind) {
  const candidates = events.filter(event => kind === undefined ? event.kind < 2 : event.kind === kind);
  if (!candidates.length) return;
  const event = candidates.find(event => event.time - 1 > time + 0.05) || candidates[0];
  setPlaying(false);
  follow(null);
  seek(event.time - 1);
  view.x = event.x; view.y = event.y;
  view.scale = Math.max(view.scale, 9);
  view.changed = performance.now();
}

let shownText = '';
function showState(step, share, alive, byGamma) {
  const external = alive - byGamma;
  const text = clockText(time - begin) + '|' + alive + (external && byGamma ? `|${byGamma}` : '');
  if (text !== shownText) {
    shownText = text;
    $('time').textContent = clockText(time);
    $('alive').textContent = alive + (alive === 1 ? ' agent' : ' agents') +
      (external && byGamma ? `, ${external} by SUMO` : external ? ', by SUMO' : '');
    if (paint === 'type') for (const li of $('legend').children) li.lastChild.textContent = counts[+li.dataset.type];
  }
  $('scrub').value = time;
  moveCursor();
  const agent = followed || hovered;
  const info = $('info');
  info.hidden = !(agent && poseAt(agent, step, share));
  if (info.hidden) return;
  const rows = [['type', spoken(map.types[agent.type].name)], ['driven by', agent.external ? 'SUMO' : 'GAMMA'],
    ['speed', `${pose.speed.toFixed(1)} m/s · ${(pose.speed * 3.6).toFixed(0)} km/h`],
    ['limited by', pose.why & 16 ? kReasons[pose.why & 15] : '–'],
    ['size', `${(agent.front - agent.back).toFixed(1)} × ${(agent.left - agent.right).toFixed(1)} m`],
    ['under way', clockText(time - times[agent.first])]];
  info.innerHTML = '<h2><i></i><span></span></h2><dl></dl>';
  info.querySelector('i').style.background = typeColour[agent.type];
  info.querySelector('span').textContent = agent.name;
  for (const [name, value] of rows) {
    const dt = document.createElement('dt'), dd = document.createElement('dd');
    dt.textContent = name; dd.textContent = value;
    info.querySelector('dl').append(dt, dd);
  }
}

const timeline = {canvas: $('timeline'), picture: document.createElement('canvas')};
function drawTimeline() {
  const w = Math.round(timeline.canvas.clientWidth * dpr), h = Math.round(timeline.canvas.clientHeight * dpr);
  if (!w || !h) return;
  timeline.canvas.width = timeline.picture.width = w;
  timeline.canvas.height = timeline.picture.height = h;
  const ctx = timeline.picture.getContext('2d'), most = Math.max(1, ...[...recording.alive].filter((_, i) => i % 10 === 0));
  const span = Math.max(end - begin, 1e-9);
  ctx.fillStyle = css.dim;
  ctx.globalAlpha = 0.28;
  for (let px = 0; px < w; ++px) {
    const step = stepAt(begin + px / w * span);
    const tall = (recording.alive[step] || 0) / most * (h - 8 * dpr);
    ctx.fillRect(px, h - tall, 1, tall);
  }
  ctx.globalAlpha = 0.95;
  for (const event of events) {
    ctx.fillStyle = kEventColours[event.kind];
    ctx.fillRect((event.time - begin) / span * w - dpr, 0, 2 * dpr, 7 * dpr);
  }
}

function moveCursor() {
  const {canvas: target, picture} = timeline, ctx = target.getContext('2d');
  if (!target.width || !picture.width) return;
  const x = (time - begin) / Math.max(end - begin, 1e-9) * target.width;
  ctx.clearRect(0, 0, target.width, target.height);
  ctx.drawImage(picture, 0, 0);
  ctx.fillStyle = css.accent;
  ctx.globalAlpha = 0.16;
  ctx.fillRect(0, 0, x, target.height);
  ctx.globalAlpha = 1;
  ctx.fillRect(Math.min(Math.max(x - dpr, 0), target.width - 2 * dpr), 0, 2 * dpr, target.height);
}

// ---- control -----------------------------------------------------------------------------------------------------

function seek(t) { time = Math.min(Math.max(t, begin), end); dirty = true; }
function setPlaying(on) {
  if (on && time >= end - 1e-9) time = begin;
  playing = on;
  $('play').classList.toggle('playing', on);
  dirty = true;
}
function follow(agent) { followed = agent; dirty = true; }
function setTheme(name) {
  root.dataset.theme = name;
  readTheme();
  still.valid = false;
  drawTimeline();
  dirty = true;
}
function setPaint(name) { paint = name; $('paint').value = name; buildLegend(); shownText = ''; dirty = true; }
function setRate(index) {
  const select = $('rate');
  select.selectedIndex = Math.min(Math.max(index, 0), select.options.length - 1);
  rate = +select.value;
}
function zoomBy(factor, px = width / 2, py = height / 2) {
  const x = toWorldX(px), y = toWorldY(py);
  view.scale = Math.min(Math.max(view.scale * factor, 0.01), 120);
  if (!followed) { view.x = x - (px - width / 2) / view.scale; view.y = y - (height / 2 - py) / view.scale; }
  view.changed = performance.now();
  dirty = true;
}

function pick(px, py) {
  const step = stepAt(time), x = toWorldX(px), y = toWorldY(py);
  let best = null, nearest = Math.max(9 / view.scale, 0.4);
  for (const agent of agents) {
    if (hidden.has(agent.type) || !poseAt(agent, step, 0)) continue;
    const dx = x - pose.x, dy = y - pose.y, cos = Math.cos(pose.h), sin = Math.sin(pose.h);
    const along = dx * cos + dy * sin, aside = dy * cos - dx * sin;
    const out = Math.hypot(Math.max(along - agent.front, agent.back - along, 0), Math.max(aside - agent.left, agent.right - aside, 0));
    if (out < nearest) { nearest = out; best = agent; }
  }
  return best;
}

let drag = null, moved = false;
const touches = new Map();
canvas.addEventListener('pointerdown', e => {
  touches.set(e.pointerId, e);
  canvas.setPointerCapture(e.pointerId);
  canvas.focus();
  drag = {x: e.clientX, y: e.clientY};
  moved = false;
});
canvas.addEventListener('pointermove', e => {
  if (!touches.has(e.pointerId)) {
    const found = pick(e.clientX, e.clientY);
    if (found !== hovered) { hovered = found; dirty = true; }
    canvas.style.cursor = found ? 'pointer' : '';
    return;
  }
  if (touches.size === 2) {
    const [a, b] = [...touches.values()], before = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    touches.set(e.pointerId, e);
    const [c, d] = [...touches.values()];
    zoomBy(Math.hypot(c.clientX - d.clientX, c.clientY - d.clientY) / Math.max(before, 1), (c.clientX + d.clientX) / 2, (c.clientY + d.clientY) / 2);
    moved = true;
    return;
  }
  touches.set(e.pointerId, e);
  const dx = e.clientX - drag.x, dy = e.clientY - drag.y;
  if (!moved && Math.hypot(dx, dy) < 4) return;
  moved = true;
  canvas.classList.add('dragging');
  follow(null);
  view.x -= dx / view.scale; view.y += dy / view.scale;
  drag = {x: e.clientX, y: e.clientY};
  view.changed = performance.now();
  dirty = true;
});
const release = e => {
  touches.delete(e.pointerId);
  canvas.classList.remove('dragging');
  if (e.type === 'pointerup' && !moved) {
    const found = pick(e.clientX, e.clientY);
    if (found || followed) follow(found);
  }
};
canvas.addEventListener('pointerup', release);
canvas.addEventListener('pointercancel', release);
canvas.addEventListener('wheel', e => {
  e.preventDefault();
  zoomBy(Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : 0.0015)), e.clientX, e.clientY);
}, {passive: false});
canvas.addEventListener('dblclick', e => zoomBy(2, e.clientX, e.clientY));

const stepBy = n => { setPlaying(false); seek(times[Math.min(Math.max(stepAt(time) + n, 0), times.length - 1)]); };
const kPaints = ['type', 'speed', 'reason'];
const keys = {
  ' ': () => setPlaying(!playing),
  ArrowLeft: e => seek(time - (e.shiftKey ? 10 : 1)),
  ArrowRight: e => seek(time + (e.shiftKey ? 10 : 1)),
  ',': () => stepBy(-1),
  '.': () => stepBy(1),
  ArrowUp: () => setRate($('rate').selectedIndex + 1),
  ArrowDown: () => setRate($('rate').selectedIndex - 1),
  '+': () => zoomBy(1.4), '=': () => zoomBy(1.4), '-': () => zoomBy(1 / 1.4),
  f: () => { follow(null); fit(bounds); },
  n: () => nextEvent(),
  c: () => setPaint(kPaints[(kPaints.indexOf(paint) + 1) % kPaints.length]),
  p: () => { trails = !trails; dirty = true; },
  t: () => setTheme(root.dataset.theme === 'light' ? 'dark' : 'light'),
  Escape: () => { follow(null); $('help').hidden = true; },
  '?': () => { $('help').hidden = !$('help').hidden; },
  Home: () => seek(begin), End: () => seek(end),
};
window.addEventListener('keydown', e => {
  if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === 'SELECT') return;
  const action = keys[e.key];
  if (!action) return;
  e.preventDefault();
  action(e);
});
window.addEventListener('resize', resize);
$('play').onclick = () => setPlaying(!playing);
$('fit').onclick = keys.f;
$('theme').onclick = keys.t;
$('keys').onclick = keys['?'];
$('rate').onchange = () => { rate = +$('rate').value; };
$('paint').onchange = () => setPaint($('paint').value);
$('scrub').oninput = () => seek(+$('scrub').value);
for (const id of ['play', 'fit', 'theme', 'keys', 'rate', 'paint'])
  $(id).addEventListener('pointerup', () => setTimeout(() => { if (document.activeElement.tagName !== 'SELECT') canvas.focus(); }, 0));

let before = null;
function frame(now) {
  if (playing) {
    const elapsed = before === null ? 0 : Math.min((now - before) / 1000, 0.25);
    time += elapsed * rate;
    if (time >= end) { time = end; setPlaying(false); }
    dirty = true;
  }
  before = now;
  if (dirty) { dirty = false; drawScene(now); }
  requestAnimationFrame(frame);
}

// ---- start -------------------------------------------------------------------------------------------------------

// #t=12&x=..&y=..&s=px per metre&theme=light&play=0&follow=NAME&paint=speed&rate=5: a view to link to
const wish = new URLSearchParams(location.hash.slice(1));
document.title = map.title + ' · sumo-gamma replay';
$('title').textContent = map.title;
$('scrub').min = begin; $('scrub').max = end;
buildMap();
width = window.innerWidth; height = window.innerHeight;
root.dataset.theme = wish.get('theme') || (matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark');
readTheme();
resize();
const busy = busyBox();
fit(map.lanes.length ? busy : bounds);
view.scale = Math.min(view.scale, 14);
if (wish.has('s')) view.scale = +wish.get('s');
if (wish.has('x')) view.x = +wish.get('x');
if (wish.has('y')) view.y = +wish.get('y');
if (wish.has('t')) seek(+wish.get('t'));
if (wish.has('follow')) follow(agents.find(agent => agent.name === wish.get('follow')) || null);
if (wish.get('paths') === '1') trails = true;
const rateIndex = [...$('rate').options].findIndex(option => option.value === wish.get('rate'));
if (rateIndex >= 0) setRate(rateIndex);
setPaint(kPaints.includes(wish.get('paint')) ? wish.get('paint') : 'type');
buildMarks();
if (times.length) {
  setPlaying(wish.get('play') !== '0');
  canvas.focus();
  drawScene(performance.now());
  requestAnimationFrame(frame);
} else {
  $('notice').textContent = 'The recording holds no step.';
}
Object.assign(root.dataset, {state: times.length ? 'ready' : 'empty', steps: times.length, agents: agents.length, events: events.length});
})();
