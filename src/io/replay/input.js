// Pointer, keys and buttons.

let drag = null, moved = false, pinched = false;  // until no finger is left
const touches = new Map();
canvas.addEventListener('pointerdown', e => {
  if (!touches.size) pinched = false;
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
    pinched = true;
    return;
  }
  if (pinched) return;
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
  if (e.type === 'pointerup' && !moved && !pinched) {
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
  n: () => jumpToNext(1), N: () => jumpToNext(-1),
  m: () => toggleList(),
  l: () => { if (live.on) goLive(); },
  c: () => setPaint(kPaints[(kPaints.indexOf(paint) + 1) % kPaints.length]),
  s: () => { if (!$('scenarios').hidden) toggleScenarios(); },
  p: () => { trails = !trails; dirty = true; },
  t: () => setTheme(root.dataset.theme === 'light' ? 'dark' : 'light'),
  Escape: () => { follow(null); $('help').hidden = true; if (!$('list').hidden) toggleList(); },
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
$('live').onclick = goLive;
$('scenarios').onclick = keys.s;
$('rate').onchange = () => { rate = +$('rate').value; };
$('paint').onchange = () => setPaint($('paint').value);
$('scrub').oninput = () => seek(+$('scrub').value);
for (const id of ['play', 'fit', 'theme', 'keys', 'rate', 'paint', 'scenarios'])
  $(id).addEventListener('pointerup', () => setTimeout(() => { if (document.activeElement.tagName !== 'SELECT') canvas.focus(); }, 0));
