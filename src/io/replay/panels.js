// Legend, counts, and what is known of the agent looked at.

const clockText = t => {
  const tenths = Math.round(t * 10), minutes = Math.floor(tenths / 600);
  return minutes + ':' + ((tenths % 600) / 10).toFixed(1).padStart(4, '0');
};
const spoken = name => name.replaceAll('_', ' ');
function made(tag, text, parent, className) {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  if (className) element.className = className;
  parent?.append(element);
  return element;
}

function legendLine(list, {colour, text, key, round, border}) {
  const li = made('li', undefined, list), swatch = made('i', undefined, li, round ? 'round' : '');
  swatch.style.background = colour;
  if (border) swatch.style.outline = `${border.width}px solid var(--${border.colour})`;
  made('span', text, li);
  made('b', '', li);
  if (key === undefined) return li;
  li.dataset.type = key;
  li.title = 'show or hide';
  li.onclick = () => { hidden.has(key) ? hidden.delete(key) : hidden.add(key); li.classList.toggle('off'); dirty = true; };
  if (hidden.has(key)) li.classList.add('off');
  return li;
}

/// Values of a column that are there at all, by every fifth step.
function present(valueOf) {
  const found = new Set();
  for (const agent of agents) for (let k = 0; k < agent.length; k += 5) found.add(valueOf(agent, k));
  return found;
}

let driverLines = [];
function buildLegend() {
  const list = $('legend');
  list.textContent = '';
  if (paint === 'type') {
    const there = new Set(agents.map(agent => agent.type));
    map.types.forEach((type, i) => { if (there.has(i)) legendLine(list, {colour: typeColour[i], text: spoken(type.name), key: i, round: type.walks}); });
  } else if (paint === 'reason') {
    const there = present((agent, k) => limitOf(agent.state[k], agent.bind[k]));
    kLimits.forEach((name, i) => { if (there.has(i)) legendLine(list, {colour: kLimitColours[i], text: name}); });
  } else {
    const bar = made('div', undefined, made('li', undefined, list), 'scale');
    bar.style.background = `linear-gradient(90deg, ${[0, 3.5, 7, 10.5, 14].map(speedColour).join(',')})`;
    const ends = made('li', undefined, list, 'ends');
    made('span', 'standing', ends); made('b', '50 km/h', ends);
  }
  buildDrivers();
}

/// Who drives whom: the outline tells.
function buildDrivers() {
  const there = present((agent, k) => agent.state[k] >> 5 & 3), list = $('drivers');
  list.textContent = '';
  driverLines = [];
  [0, 1, 3, 2].forEach(control => {
    if (!there.has(control)) return;
    const li = legendLine(list, {colour: 'var(--road)', text: 'driven by ' + kDrivers[control],
      border: {colour: kDriverColours[control], width: Math.max(kDriverWidths[control], 1)}});
    driverLines.push({control, count: li.lastChild});
  });
}

let shownText = '';
function showState(step, share, alive, byDriver) {
  const text = clockText(time) + '|' + alive + '|' + byDriver.join();
  if (text !== shownText) {
    shownText = text;
    $('time').textContent = clockText(time);
    $('alive').textContent = alive + (alive === 1 ? ' agent' : ' agents');
    if (paint === 'type') for (const li of $('legend').children) li.lastChild.textContent = counts[+li.dataset.type];
    for (const {control, count} of driverLines) count.textContent = byDriver[control];
  }
  $('scrub').value = time;
  moveCursor();
  const agent = followed || hovered, info = $('info');
  info.hidden = !(agent && poseAt(agent, step, share));
  if (!info.hidden) showAgent(agent, step);
}

const inspector = {agent: null, values: new Map()};
/// The lines of the inspector stay, their words change: what is clicked on isn't replaced under the finger.
function buildInspector(agent) {
  const info = $('info');
  Object.assign(inspector, {agent, space: null, planShown: null});
  inspector.values.clear();
  info.textContent = '';
  const head = made('h2', undefined, info);
  made('i', undefined, head).style.background = typeColour[agent.type];
  made('span', agent.name, head);
  if (agent === followed) {
    const close = made('button', '×', head, 'close');
    close.title = close.ariaLabel = 'let it go (esc)';
    close.onclick = () => follow(null);
  }
  const list = made('dl', undefined, info);
  for (const name of ['type', 'driven by', 'speed', 'now', 'behaviour', 'likes to go', 'size', 'under way']) {
    made('dt', name, list);
    inspector.values.set(name, made('dd', '', list));
  }
  inspector.plan = made('div', undefined, info, 'plan');
  const space = made('div', undefined, info, 'space');
  inspector.caption = made('p', '', space);
  inspector.picture = made('canvas', undefined, space);
  inspector.list = made('ol', undefined, space);
  inspector.picture.setAttribute('aria-label', 'velocity space');
}

function tell(name, text) {
  const value = inspector.values.get(name);
  if (value.textContent !== text) value.textContent = text;
  return value;
}

function behaviourWords(agent) {
  const {responsibility, ahead, behind, headway, keepsRules} = agent.behaviour;
  return (keepsRules ? 'keeps every rule' : 'breaks some rules, as recorded of people') + `; responsibility ${responsibility.toFixed(2)}` +
    `; attends ${ahead.toFixed(0)} m ahead, ${behind.toFixed(0)} m behind` +
    (map.types[agent.type].walks || headway === 1 ? '' : `; headway × ${headway.toFixed(2)}`);
}

function showAgent(agent, step) {
  if (inspector.agent !== agent || inspector.wasFollowed !== followed) buildInspector(agent);
  inspector.wasFollowed = followed;
  const {state, bind, control, k, speed} = pose;
  const foe = recording.byId.get(foeAt(agent, k));
  tell('type', spoken(map.types[agent.type].name));
  tell('driven by', kDrivers[control]);
  tell('speed', `${speed.toFixed(1)} m/s · ${(speed * 3.6).toFixed(0)} km/h`);
  const now = tell('now', limitWords(state, bind, foe?.name ?? ''));
  now.classList.toggle('link', !!foe);
  now.onclick = foe ? () => follow(foe) : null;
  tell('behaviour', control === 0 ? behaviourWords(agent) : kBehaviours[control]);
  // on wheels the road says more: their own limit is mostly the body's
  tell('likes to go', control === 3 ? kBehaviours[control] : map.types[agent.type].walks ? `${agent.behaviour.speed.toFixed(1)} m/s` : 'as the road allows');
  tell('size', `${(agent.front - agent.back).toFixed(1)} × ${(agent.left - agent.right).toFixed(1)} m`);
  tell('under way', clockText(time - times[agent.first]));
  showPlan(agent, step, pose.h);
  showSpace(agent, step, pose.h, control);
}

function showSpace(agent, step, h, control) {
  const space = spaceAt(recording, agent.id, step);
  inspector.picture.hidden = inspector.list.hidden = !space;
  if (!space) {
    const words = control !== 0 ? '' : recording.spaces.has(agent.id) ? 'no velocity space at this moment'
      : `velocity space: run with --inspect ${agent.name}`;
    if (inspector.caption.textContent !== words) inspector.caption.textContent = words;
    inspector.space = null;
    return;
  }
  if (inspector.space === space && inspector.theme === root.dataset.theme) return;
  Object.assign(inspector, {space, theme: root.dataset.theme});
  inspector.caption.textContent = 'velocity space, ahead is up' +
    (space.violation > 0.005 ? `; G can't be met by ${space.violation.toFixed(2)} m/s` : '');
  drawSpace(inspector.picture, space, h);
  inspector.list.textContent = '';
  const speedOf = v => Math.hypot(...v).toFixed(2) + ' m/s';
  const line = (mark, text, value, bold) => {
    const li = made('li', undefined, inspector.list, bold ? 'binds' : '');
    made('i', mark, li); made('span', text, li); made('b', value, li);
    return li;
  };
  line('▲', 'preferred', speedOf(space.preferred));
  line('○', 'velocity', speedOf(space.velocity));
  line('●', space.binding === kBind.guard ? 'chosen, by the stopping guard' : 'chosen', speedOf(space.chosen)).firstChild.style.color = css.accent;
  for (const plane of planesByWeight(space).slice(0, 6)) {
    const li = line('▬', planeName(plane) + (plane.binds ? ' — binds' : ''), plane.slack.toFixed(2).replace('-0.00', '0.00'), plane.binds);
    li.firstChild.style.color = kSetColours[planeSet(plane.kind)];
  }
  if (space.planes.length > 6) line('', `${space.planes.length - 6} more half-planes, further off`, '');
}
