// The velocity space of one agent: what Eq. 7 chose from, as the program recorded it. Nothing is computed anew here.

const kSetColours = {K: '#8a949e', C: '#e69f00', G: '#56b4e9'};
const kSetDashes = {K: [2, 3], C: [7, 4], G: []};

/// Where the border of a plane crosses the disc of this radius: [from, to], null where it doesn't. Forward is up: `h` is the
/// agent's heading.
function borderIn(plane, radius, h) {
  if (Math.abs(plane.offset) >= radius) return null;
  const cos = Math.cos(Math.PI / 2 - h), sin = Math.sin(Math.PI / 2 - h);
  const n = [plane.normal[0] * cos - plane.normal[1] * sin, plane.normal[0] * sin + plane.normal[1] * cos];
  const half = Math.sqrt(radius * radius - plane.offset * plane.offset);
  const middle = [n[0] * plane.offset, n[1] * plane.offset];
  return {n, from: [middle[0] - n[1] * half, middle[1] + n[0] * half], to: [middle[0] + n[1] * half, middle[1] - n[0] * half]};
}

/// How far inside a plane a velocity is [m/s]; negative outside.
const slackOf = (plane, v) => plane.normal[0] * v[0] + plane.normal[1] * v[1] - plane.offset;

/// Planes by how near they are to what was chosen, the one that binds first.
function planesByWeight(space) {
  return space.planes.map((plane, i) => ({...plane, binds: i === space.plane, slack: slackOf(plane, space.chosen)}))
    .sort((a, b) => (b.binds - a.binds) || a.slack - b.slack);
}

function planeName(plane) {
  const foe = plane.foe < 0 ? '' : plane.kind === 2 ? ` no. ${plane.foe}` : ' ' + nameOf(plane.foe);
  return kPlaneKinds[plane.kind] + foe;
}

/// Speed at the picture's rim [m/s]. What is preferred may lie beyond it.
function rimOf(space) {
  return Math.max(1.5 * space.fastest, 1.2 * Math.hypot(...space.velocity), 1.2 * Math.hypot(...space.chosen), 1);
}

/// A velocity drawn in to the rim where it is beyond.
function within(v, rim) {
  const length = Math.hypot(...v), most = 0.95 * rim;
  return length > most ? [v[0] * most / length, v[1] * most / length] : v;
}

function drawSpace(picture, space, h) {
  const size = picture.clientWidth || 230, ctx = picture.getContext('2d');
  picture.width = picture.height = Math.round(size * dpr);
  ctx.setTransform(dpr, 0, 0, dpr, 0, 0);
  const rim = rimOf(space), middle = size / 2, scale = (size / 2 - 4) / rim;
  const cos = Math.cos(Math.PI / 2 - h), sin = Math.sin(Math.PI / 2 - h);
  const at = v => [middle + (v[0] * cos - v[1] * sin) * scale, middle - (v[0] * sin + v[1] * cos) * scale];
  const turned = p => [middle + p[0] * scale, middle - p[1] * scale];
  ctx.save();
  ctx.beginPath(); ctx.arc(middle, middle, rim * scale, 0, 2 * Math.PI); ctx.clip();
  ctx.fillStyle = css.ground; ctx.fillRect(0, 0, size, size);
  // what each plane forbids
  for (const plane of space.planes) {
    const set = planeSet(plane.kind), border = borderIn(plane, 1.5 * rim, h);
    if (!border) continue;
    const far = p => [p[0] - border.n[0] * 3 * rim, p[1] - border.n[1] * 3 * rim];
    ctx.fillStyle = kSetColours[set];
    ctx.globalAlpha = 0.16;
    ctx.beginPath();
    for (const p of [border.from, border.to, far(border.to), far(border.from)]) ctx.lineTo(...turned(p));
    ctx.fill();
  }
  ctx.globalAlpha = 1;
  space.planes.forEach((plane, i) => {
    const set = planeSet(plane.kind), border = borderIn(plane, 1.5 * rim, h);
    if (!border) return;
    ctx.strokeStyle = kSetColours[set];
    ctx.lineWidth = i === space.plane ? 3 : 1.2;
    ctx.setLineDash(kSetDashes[set]);
    ctx.beginPath(); ctx.moveTo(...turned(border.from)); ctx.lineTo(...turned(border.to)); ctx.stroke();
  });
  ctx.setLineDash([]);
  ctx.strokeStyle = css.dim; ctx.lineWidth = 1;
  ctx.beginPath(); ctx.arc(middle, middle, space.fastest * scale, 0, 2 * Math.PI); ctx.stroke();
  ctx.beginPath(); ctx.moveTo(middle - 4, middle); ctx.lineTo(middle + 4, middle); ctx.moveTo(middle, middle - 4); ctx.lineTo(middle, middle + 4); ctx.stroke();
  labelFoes(ctx, space, {h, rim, turned, size});
  drawVelocities(ctx, space, at, rim);
  ctx.restore();
  ctx.strokeStyle = css.line;
  ctx.beginPath(); ctx.arc(middle, middle, rim * scale, 0, 2 * Math.PI); ctx.stroke();
  ctx.fillStyle = css.dim; ctx.font = '10px system-ui, sans-serif'; ctx.textAlign = 'right';
  ctx.fillText(space.fastest.toFixed(1) + ' m/s', size - 2, 10);
}

/// Names of others at their planes: the few that are nearest to what was chosen.
function labelFoes(ctx, space, {h, rim, turned, size}) {
  ctx.font = '10px system-ui, sans-serif';
  ctx.textAlign = 'center';
  ctx.fillStyle = css.text;
  for (const plane of planesByWeight(space).filter(plane => planeSet(plane.kind) === 'G').slice(0, 4)) {
    const border = borderIn(plane, 0.9 * rim, h);
    if (!border) continue;
    const [x, y] = turned([border.n[0] * (plane.offset - 0.09 * rim), border.n[1] * (plane.offset - 0.09 * rim)]);
    ctx.fillText(nameOf(plane.foe), Math.min(Math.max(x, 26), size - 26), y + 3);
  }
}

function drawVelocities(ctx, space, at, rim) {
  const dot = (v, r, fill, stroke) => {
    ctx.beginPath(); ctx.arc(...at(v), r, 0, 2 * Math.PI);
    if (fill) { ctx.fillStyle = fill; ctx.fill(); }
    if (stroke) { ctx.strokeStyle = stroke; ctx.lineWidth = 1.5; ctx.stroke(); }
  };
  dot(space.velocity, 5, null, css.text);
  tracePin(ctx, 'triangle', ...at(within(space.preferred, rim)), 5);
  ctx.fillStyle = css.text; ctx.fill();
  ctx.strokeStyle = css.accent; ctx.lineWidth = 2;
  ctx.beginPath(); ctx.moveTo(...at([0, 0])); ctx.lineTo(...at(space.chosen)); ctx.stroke();
  dot(space.chosen, 4, css.accent);
}
