// The map as paths, by level and look.

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
