// What keys, buttons and the pointer do.

function seek(t) { live.chase = false; time = Math.min(Math.max(t, begin), end); dirty = true; }
function setPlaying(on) {
  if (on && time >= end - 1e-9) { if (live.on && !live.over) live.chase = true; else time = begin; }
  if (!on) live.chase = false;
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
function goLive() { live.chase = true; playing = true; $('play').classList.add('playing'); time = end; dirty = true; }
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
