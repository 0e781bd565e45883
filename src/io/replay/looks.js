// Colours. Those of Okabe and Ito, which people with any kind of colour vision tell apart, and shapes beside them.

const kTypeColours = {
  car: '#56b4e9', van: '#4f83cc', bus: '#f0e442', truck: '#d55e00', motorcycle: '#cc79a7', bicycle: '#00a67a',
  pedestrian: '#f0a020', electric_tricycle: '#b8d68a', gyro_scooter: '#c9c9c9',
};
const kSpareColours = ['#d7dde4', '#8c6bb1', '#a6761d', '#a0c4ff', '#e0aaff'];
const kLimitColours = ['#dfe5ea', '#d55e00', '#f0e442', '#56b4e9', '#cc79a7', '#a6761d', '#00a67a', '#e69f00', '#4f83cc', '#ff3b30', '#7d8791'];
const kEventColours = ['#d62728', '#e69f00', '#b06fd0', '#f0e442', '#9aa5b1', '#56b4e9', '#00a67a', '#cc79a7'];
const kDriverColours = ['outline', 'halo', 'dim', 'accent'];  // of outlines, as names of the theme
const typeColour = map.types.map((type, i) => kTypeColours[type.name] || kSpareColours[i % kSpareColours.length]);
const hidden = new Set();       // types
const hiddenEvents = new Set(kEvents.map((kind, i) => kind.quiet ? i : -1).filter(i => i >= 0));
let css = {};

function readTheme() {
  const style = getComputedStyle(root);
  for (const name of ['ground', 'road', 'walk', 'area', 'cycle', 'rail', 'building', 'wall', 'mark', 'middle', 'zebra', 'bridge',
    'text', 'dim', 'accent', 'outline', 'glass', 'halo', 'line', 'card']) css[name] = style.getPropertyValue('--' + name).trim();
}

/// Dark blue to yellow (a few stops of viridis): lightness alone tells.
const kSpeedStops = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
function speedColour(speed) {
  const share = Math.min(Math.max(speed, 0) / 14, 1) * (kSpeedStops.length - 1), i = Math.min(Math.floor(share), kSpeedStops.length - 2);
  const mix = kSpeedStops[i].map((from, k) => Math.round(from + (kSpeedStops[i + 1][k] - from) * (share - i)));
  return `rgb(${mix.join()})`;
}

/// A mark about (x, y), `r` its half width.
function tracePin(ctx, shape, x, y, r) {
  ctx.beginPath();
  if (shape === 'cross') {
    ctx.moveTo(x - r, y - r); ctx.lineTo(x + r, y + r); ctx.moveTo(x + r, y - r); ctx.lineTo(x - r, y + r);
  } else if (shape === 'triangle') {
    ctx.moveTo(x, y - r); ctx.lineTo(x + r, y + r); ctx.lineTo(x - r, y + r); ctx.closePath();
  } else if (shape === 'square') {
    ctx.rect(x - 0.85 * r, y - 0.85 * r, 1.7 * r, 1.7 * r);
  } else if (shape === 'bar') {
    ctx.rect(x - r, y - 0.4 * r, 2 * r, 0.8 * r);
  } else {
    ctx.arc(x, y, 0.85 * r, 0, 2 * Math.PI);
  }
}

function drawPin(ctx, kind, x, y, r) {
  const {shape} = kEvents[kind];
  tracePin(ctx, shape, x, y, r);
  ctx.fillStyle = ctx.strokeStyle = kEventColours[kind];
  ctx.lineWidth = 0.5 * r;
  if (shape !== 'cross' && shape !== 'ring') ctx.fill(); else ctx.stroke();
  if (shape === 'cross' || shape === 'ring') return;
  // light ones on light ground
  ctx.strokeStyle = css.outline;
  ctx.lineWidth = 0.14 * r;
  ctx.stroke();
}
