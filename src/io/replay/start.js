// The page's clock, and how it starts.

let before = null;
function frame(now) {
  if (playing) {
    const elapsed = before === null ? 0 : Math.min((now - before) / 1000, 0.25);
    if (live.chase) chase(elapsed);
    else time += elapsed * rate;
    if (time >= end) { time = end; if (!live.on || live.over) setPlaying(false); else live.chase = true; }
    dirty = true;
  }
  before = now;
  if (dirty) { dirty = false; drawScene(now); }
  requestAnimationFrame(frame);
}


// #t=12&x=..&y=..&s=px per metre&theme=light&play=0&follow=NAME&paint=speed&rate=5&paths=1&scenarios=1&list=1&mark=3: a view to link to
const wish = new URLSearchParams(location.hash.slice(1));
document.title = map.title + ' · sumo-gamma replay';
$('title').textContent = map.title;
$('scrub').min = begin; $('scrub').max = end;
buildMap();
width = window.innerWidth; height = window.innerHeight;
root.dataset.theme = wish.get('theme') || (matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark');
readTheme();
resize();
if (times.length && !live.on) time = times[openingStep(recording.alive)];
const busy = busyBox();
openView(map.lanes.length ? busy : bounds);
if (wish.has('s')) view.scale = +wish.get('s');
if (wish.has('x')) view.x = +wish.get('x');
if (wish.has('y')) view.y = +wish.get('y');
if (wish.has('t')) seek(+wish.get('t'));
if (live.on) live.chase = !wish.has('t');
if (wish.get('list') === '1') toggleList();
if (wish.has('bare')) root.dataset.bare = '';
if (wish.has('follow')) follow(agents.find(agent => agent.name === wish.get('follow')) || null);
if (wish.get('paths') === '1') trails = true;
$('scenarios').hidden = !recording.plans.some(plan => plan.scenarios.length);
if (wish.get('scenarios') === '1') keys.s();
if (wish.has('mark') && events[+wish.get('mark')]) jumpTo(events[+wish.get('mark')]);
const rateIndex = [...$('rate').options].findIndex(option => option.value === wish.get('rate'));
if (rateIndex >= 0) setRate(rateIndex);
setPaint(kPaints.includes(wish.get('paint')) ? wish.get('paint') : 'type');
buildMarks();
if (live.on) showLive();
if (times.length) {
  setPlaying(wish.get('play') !== '0');
  canvas.focus();
  drawScene(performance.now());
  requestAnimationFrame(frame);
} else {
  $('notice').textContent = 'The recording holds no step.';
}
Object.assign(root.dataset, {state: times.length ? 'ready' : 'empty', steps: times.length, agents: agents.length, events: events.length,
  plans: recording.plans.length});

// what draws pictures from outside: the page at an instant
window.replay = {
  span: () => [begin, end],
  show: t => {
    setPlaying(false);
    seek(t);
    // at once, whatever the map's picture costs
    drawScene(performance.now() + 1e6);
    dirty = false;
  },
};
