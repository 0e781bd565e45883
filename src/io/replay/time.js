// The instant that is shown, and where agents are then.

let time = begin, playing = false, rate = 1, followed = null, hovered = null, paint = 'type', trails = false;

/// Index of the last step at or before t.
function stepAt(t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t + 1e-9) low = middle; else high = middle - 1;
  }
  return low;
}

const pose = {x: 0, y: 0, h: 0, speed: 0, slowing: false, state: 0, bind: 0, control: 0, k: 0};
function speedOver(agent, a, b) {
  a = Math.max(a, 0); b = Math.min(b, agent.length - 1);
  return b > a ? Math.hypot(agent.x[b] - agent.x[a], agent.y[b] - agent.y[a]) / (times[agent.first + b] - times[agent.first + a]) : 0;
}
/// Pose of an agent between two steps; false where it isn't alive.
function poseAt(agent, step, share) {
  const k = step - agent.first;
  if (k < 0 || k >= agent.length) return false;
  const next = Math.min(k + 1, agent.length - 1);
  pose.x = agent.x[k] + (agent.x[next] - agent.x[k]) * share;
  pose.y = agent.y[k] + (agent.y[next] - agent.y[k]) * share;
  pose.h = agent.h[k] + (agent.h[next] - agent.h[k]) * share;
  pose.k = k;
  pose.state = agent.state[k];
  pose.control = pose.state >> 5 & 3;
  pose.bind = agent.bind[k];
  pose.speed = speedOver(agent, k - 1, k + 1);
  pose.slowing = pose.speed < 0.15 || speedOver(agent, k - 1, k + 2) < speedOver(agent, k - 5, k - 2) - 0.3;
  return true;
}

/// Share of the way from a step to the next one at the instant shown.
function shareOf(step) {
  const next = Math.min(step + 1, times.length - 1);
  return next > step ? Math.min(Math.max((time - times[step]) / (times[next] - times[step]), 0), 1) : 0;
}

const nameOf = id => recording.byId.get(id)?.name ?? '';
/// Id of whom an agent is held by at its k-th step, -1 for nobody.
function foeAt(agent, k) {
  if (agent.bind[k] === kBind.neighbour) return agent.bindFoe[k];
  return agent.bind[k] === kBind.road ? agent.foe[k] : -1;
}
