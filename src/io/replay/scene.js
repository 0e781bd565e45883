// All that moves: signals, agents, their trails, what happened.

const kLights = {G: '#35d06b', g: '#35d06b', y: '#ffc53d', Y: '#ffc53d', r: '#ff4550', u: '#ff8c42', s: '#35d06b'};
const cursors = [];

function signalState(signal, step) {
  const changes = recording.signals[signal];
  if (!changes || changes[0].step > step) return '';
  let at = cursors[signal] || 0;
  if (changes[at].step > step) at = 0;
  while (at + 1 < changes.length && changes[at + 1].step <= step) ++at;
  cursors[signal] = at;
  return changes[at].state;
}

function drawSignals(step) {
  if (view.scale < 0.7) return;
  screen.lineCap = 'butt';
  screen.lineWidth = Math.max(0.45 * view.scale, 2.2) ;
  for (const [px, py, heading, half, links] of map.stopLines) {
    const x = px / 10, y = py / 10, sx = toScreenX(x), sy = toScreenY(y);
    if (sx < -40 || sy < -40 || sx > width + 40 || sy > height + 40) continue;
    const count = links.length / 2, w = 2 * half / 10 * 0.92 / count;
    // left of the direction of travel, on a screen whose y points down
    const lx = -Math.sin(heading / 1000), ly = -Math.cos(heading / 1000);
    for (let i = 0; i < count; ++i) {
      const state = signalState(links[2 * i], step);
      screen.strokeStyle = kLights[state[links[2 * i + 1]]] || '#8a949e';
      const from = (-half / 10 * 0.92 + i * w) * view.scale, to = from + w * 0.94 * view.scale;
      screen.beginPath();
      screen.moveTo(sx + lx * from, sy + ly * from);
      screen.lineTo(sx + lx * to, sy + ly * to);
      screen.stroke();
    }
  }
}

function drawTrail(agent, step, colour) {
  const last = Math.min(step - agent.first, agent.length - 1);
  if (last < 1) return;
  const seconds = 10;
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  screen.strokeStyle = colour;
  screen.lineWidth = Math.max(1.5, Math.min(0.35 * view.scale, 4));
  screen.lineJoin = screen.lineCap = 'round';
  screen.globalAlpha = 0.55;
  screen.beginPath();
  for (let k = last; k >= 0 && times[step] - times[agent.first + k] <= seconds; --k) {
    const x = toScreenX(agent.x[k]), y = toScreenY(agent.y[k]);
    if (k === last) screen.moveTo(x, y); else screen.lineTo(x, y);
  }
  screen.stroke();
  screen.globalAlpha = 1;
}

function drawEvents() {
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  const shown = 2.5;
  for (const event of events) {
    if (event.time > time + shown) break;
    const age = time - event.time;
    if (hiddenEvents.has(event.kind) || age < -0.05 && event !== marked || age > shown) continue;
    const share = Math.min(Math.max(age, 0) / shown, 1), x = toScreenX(event.x), y = toScreenY(event.y);
    screen.globalAlpha = 1 - share;
    drawPin(screen, event.kind, x, y - 22, 8);
    screen.lineWidth = 3;
    screen.beginPath();
    screen.arc(x, y, 10 + 26 * share, 0, 2 * Math.PI);
    screen.stroke();
  }
  screen.globalAlpha = 1;
}

/// From who is looked at to whom it is held by.
function drawBond(step, share) {
  const agent = followed || hovered;
  if (!agent || !poseAt(agent, step, share)) return;
  const foe = recording.byId.get(foeAt(agent, pose.k)), x = toScreenX(pose.x), y = toScreenY(pose.y);
  if (!foe || !poseAt(foe, step, share)) return;
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  screen.strokeStyle = css.accent;
  screen.lineWidth = 1.5;
  screen.setLineDash([5, 4]);
  screen.beginPath();
  screen.moveTo(x, y); screen.lineTo(toScreenX(pose.x), toScreenY(pose.y));
  screen.stroke();
  screen.setLineDash([]);
}

function drawScaleBar() {
  const steps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];
  const metres = steps.find(m => m * view.scale > 60) || 10000;
  const length = metres * view.scale, x = width - 24 - length, y = height - 82;
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  screen.strokeStyle = screen.fillStyle = css.dim;
  screen.lineWidth = 1.5;
  screen.beginPath();
  screen.moveTo(x, y - 5); screen.lineTo(x, y); screen.lineTo(x + length, y); screen.lineTo(x + length, y - 5);
  screen.stroke();
  screen.font = '11px system-ui, sans-serif';
  screen.textAlign = 'right';
  screen.fillText(metres >= 1000 ? metres / 1000 + ' km' : metres + ' m', x + length - 4, y - 6);
}

const counts = new Uint32Array(map.types.length), byDriver = [0, 0, 0, 0];
function drawScene(now) {
  const step = stepAt(time), share = shareOf(step);
  if (followed && poseAt(followed, step, share)) { view.x = pose.x; view.y = pose.y; }
  drawStill(now);
  screen.setTransform(dpr, 0, 0, dpr, 0, 0);
  drawSignals(step);
  counts.fill(0);
  byDriver.fill(0);
  let alive = 0;
  if (trails) for (const agent of agents) if (!hidden.has(agent.type) && poseAt(agent, step, share)) drawTrail(agent, step, colourOf(agent));
  if (followed && !trails) drawTrail(followed, step, css.accent);
  drawScenarios(step);
  // people on foot last: they are small
  for (const walks of [false, true])
    for (const agent of agents) {
      if (map.types[agent.type].walks !== walks || !poseAt(agent, step, share)) continue;
      ++counts[agent.type]; ++alive; ++byDriver[pose.control];
      if (!hidden.has(agent.type)) drawAgent(agent);
    }
  drawPlan(step);
  drawBond(step, share);
  drawEvents();
  drawScaleBar();
  showMark();
  showState(step, share, alive, byDriver);
}
