// What of the map is on the screen, and the map drawn there.

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

/// All of the traffic where that can be seen so; else where most of it is now, near enough to tell cars from buses.
function openView(box) {
  fit(box);
  const kNear = 4;  // [px/m]
  const here = stepAt(time), xs = [], ys = [];
  for (const agent of agents) if (poseAt(agent, here, 0)) { xs.push(pose.x); ys.push(pose.y); }
  const place = view.scale < kNear && densestPlace(xs, ys, width / kNear, height / kNear);
  if (place) Object.assign(view, {x: place.x, y: place.y, scale: kNear});
  view.scale = Math.min(view.scale, 14);
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
