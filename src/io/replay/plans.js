// What the ego's planner believed, sampled and chose, as the program recorded it at its plans. Nothing is computed anew here.

let scenariosShown = false;

/// The plan that holds at the instant shown; null where there is none, or no ego (any more).
function presentPlan(step) {
  const plan = planAt(recording.plans, time), ego = plan && recording.byId.get(plan.ego);
  return ego && step >= ego.first && step < ego.first + ego.length ? plan : null;
}

/// Angle of a line's end against a heading, left positive [rad]; null where the line goes nowhere.
function turnOf(line, h) {
  const [x, y] = line[line.length - 1], before = line.findLast(p => Math.hypot(x - p[0], y - p[1]) > 0.1);
  if (!before) return null;
  const turn = Math.atan2(y - before[1], x - before[0]) - h;
  return Math.atan2(Math.sin(turn), Math.cos(turn));
}

function beginLines() {
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  screen.lineCap = screen.lineJoin = 'round';
}

/// Where an agent goes in a scenario.
const lineOf = (plan, part) => part.way < 0 ? part.line : plan.beliefs.get(part.id)?.[part.way]?.line ?? [];

function traceLine(line) {
  screen.beginPath();
  line.forEach(([x, y], i) => i ? screen.lineTo(toScreenX(x), toScreenY(y)) : screen.moveTo(toScreenX(x), toScreenY(y)));
}

/// A ring where it goes nowhere.
function strokeWay(line, radius) {
  traceLine(line);
  if (turnOf(line, 0) === null) { screen.beginPath(); screen.arc(toScreenX(line[0][0]), toScreenY(line[0][1]), radius, 0, 2 * Math.PI); }
  screen.stroke();
}

/// Places with so much room between them that labels can be read: who comes later gives way, to the right.
function apart(places, room) {
  const placed = [];
  for (const [x, y] of places) {
    let free = x;
    while (placed.some(p => Math.hypot(p[0] - free, p[1] - y) < room)) free += room / 4;
    placed.push([free, y]);
  }
  return placed;
}

/// The numbers of ways, at their ends.
function labelWays(ways, radius) {
  const ends = ways.map(({line}) => {
    const [x, y] = line[line.length - 1];
    return [toScreenX(x) - (turnOf(line, 0) === null ? radius + 10 : 0), toScreenY(y)];
  });
  apart(ends, 17).forEach(([x, y], i) => {
    screen.fillStyle = css.card;
    screen.beginPath(); screen.arc(x, y, 8, 0, 2 * Math.PI); screen.fill();
    screen.fillStyle = css.text;
    screen.fillText(i + 1, x, y);
  });
}

/// The likelier a way, the wider and the less transparent.
function drawWays(ways) {
  const radius = 18;
  screen.strokeStyle = css.accent;
  for (const {probability, line} of ways) {
    screen.globalAlpha = 0.2 + 0.7 * probability;
    screen.lineWidth = 1.5 + 6.5 * probability;
    strokeWay(line, radius);
  }
  screen.globalAlpha = 1;
  screen.font = '11px system-ui, sans-serif';
  screen.textAlign = 'center';
  screen.textBaseline = 'middle';
  labelWays(ways, radius);
  screen.textBaseline = 'alphabetic';
}

/// Each agent's line in every scenario, over one another: what most have is most opaque. A dot is a second.
function drawScenarios(step) {
  const plan = scenariosShown && presentPlan(step);
  if (!plan) return;
  beginLines();
  screen.globalAlpha = 0.35;
  screen.lineWidth = 1.8;
  for (const scenario of plan.scenarios) for (const part of scenario) {
    const agent = recording.byId.get(part.id), line = lineOf(plan, part);
    if (!agent || !line.length || hidden.has(agent.type)) continue;
    screen.strokeStyle = screen.fillStyle = part.id === plan.ego ? css.accent : typeColour[agent.type];
    strokeWay(line, 9);
    for (const [x, y] of part.line.slice(1)) {
      screen.beginPath(); screen.arc(toScreenX(x), toScreenY(y), 2.2, 0, 2 * Math.PI); screen.fill();
    }
  }
  screen.globalAlpha = 1;
  screen.lineCap = 'butt';
}

/// Of the agent looked at.
function drawPlan(step) {
  const plan = presentPlan(step), agent = followed || hovered;
  if (!plan || !agent) return;
  beginLines();
  drawWays(plan.beliefs.get(agent.id) ?? []);
  if (agent.id === plan.ego && plan.trajectory.length) {
    screen.lineWidth = 3;
    strokeWay(plan.trajectory, 18);
  }
  screen.lineCap = 'butt';
}

function toggleScenarios() {
  scenariosShown = !scenariosShown;
  $('scenarios').classList.toggle('on', scenariosShown);
  dirty = true;
}

/// Lines of the inspector: {mark, text, value, share, bold}.
function planLines(plan, id, h) {
  if (id === plan.ego)
    return plan.choices.map(choice => {
      const chosen = Math.abs(choice.acceleration - plan.acceleration) < 1e-3;
      return {mark: chosen ? '●' : '○', text: accelerationWords(choice.acceleration), value: figureWords(plan.figures, choice), bold: chosen,
        share: plan.figures === kFigures.meetings ? choice.lower : 0};
    });
  return (plan.beliefs.get(id) ?? []).map(({probability, line}, i) =>
    ({mark: i + 1, text: wayWords(turnOf(line, h)), value: `${(100 * probability).toFixed(0)} %`, share: probability, bold: false}));
}

/// Of the ego what it does, of others what it thinks they may do.
function showPlan(agent, step, h) {
  const plan = presentPlan(step), box = inspector.plan;
  const lines = plan ? planLines(plan, agent.id, h) : [];
  const about = plan && (agent.id === plan.ego || lines.length) ? plan : null;
  box.hidden = !about;
  if (!about || inspector.planShown === about) return;
  inspector.planShown = about;
  box.textContent = '';
  made('p', agent.id === plan.ego ? planWords(plan) : 'the ego’s planner believes', box);
  const list = made('ol', undefined, box);
  for (const {mark, text, value, share, bold} of lines) {
    const li = made('li', undefined, list, bold ? 'binds' : '');
    made('i', mark, li); made('span', text, li); made('b', value, li);
    li.style.setProperty('--share', `${100 * share}%`);
  }
  if (agent.id === plan.ego && lines.length) made('p', kFigureNames[plan.figures], box);
}
