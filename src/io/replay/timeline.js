// How many are alive when, and what happened when, along the slider.

const timeline = {canvas: $('timeline'), picture: document.createElement('canvas')};
function drawTimeline() {
  const w = Math.round(timeline.canvas.clientWidth * dpr), h = Math.round(timeline.canvas.clientHeight * dpr);
  if (!w || !h) return;
  timeline.canvas.width = timeline.picture.width = w;
  timeline.canvas.height = timeline.picture.height = h;
  const ctx = timeline.picture.getContext('2d');
  const most = recording.alive.reduce((a, b) => Math.max(a, b), 1);
  const span = Math.max(end - begin, 1e-9);
  ctx.fillStyle = css.dim;
  ctx.globalAlpha = 0.28;
  for (let px = 0; px < w; ++px) {
    const step = stepAt(begin + px / w * span);
    const tall = (recording.alive[step] || 0) / most * (h - 10 * dpr);
    ctx.fillRect(px, h - tall, 1, tall);
  }
  ctx.globalAlpha = 0.95;
  // the grave ones last, over the others
  for (const kind of [4, 7, 6, 5, 1, 3, 2, 0]) {
    if (hiddenEvents.has(kind)) continue;
    const places = eventsHere().filter(event => event.kind === kind).map(event => Math.min((event.time - begin) / span, 1) * w);
    // where shapes would hide one another: how many there are
    const crowded = places.length * 12 * dpr > w;
    if (crowded) drawDensity(ctx, kEventColours[kind], places, w);
    else for (const x of places) drawPin(ctx, kind, x, 5 * dpr, 4 * dpr);
  }
}

/// A band at the top, the taller the more happen there.
function drawDensity(ctx, colour, places, w) {
  const wide = 6 * dpr, bins = new Array(Math.ceil(w / wide) + 1).fill(0);
  for (const x of places) ++bins[Math.max(Math.floor(x / wide), 0)];
  const most = Math.max(...bins);
  ctx.fillStyle = colour;
  bins.forEach((count, i) => { if (count) ctx.fillRect(i * wide, 0, wide - dpr, (2 + 7 * count / most) * dpr); });
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
