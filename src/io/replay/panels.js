// Legend, counts, and what is known of the agent looked at.

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
