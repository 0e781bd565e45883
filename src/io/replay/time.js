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

const pose = {x: 0, y: 0, h: 0, speed: 0, slowing: false, why: 0};
/// Pose of an agent between two steps; false where it isn't alive.
function poseAt(agent, step, share) {
  const k = step - agent.first;
  if (k < 0 || k >= agent.length) return false;
  const next = Math.min(k + 1, agent.length - 1);
  pose.x = agent.x[k] + (agent.x[next] - agent.x[k]) * share;
  pose.y = agent.y[k] + (agent.y[next] - agent.y[k]) * share;
  pose.h = agent.h[k] + (agent.h[next] - agent.h[k]) * share;
  pose.why = agent.why[k];
  const speedOver = (a, b) => {
    a = Math.max(a, 0); b = Math.min(b, agent.length - 1);
    return b > a ? Math.hypot(agent.x[b] - agent.x[a], agent.y[b] - agent.y[a]) / (times[agent.first + b] - times[agent.first + a]) : 0;
  };
  pose.speed = speedOver(k - 1, k + 1);
  pose.slowing = speedOver(k - 1, k + 2) < speedOver(k - 5, k - 2) - 0.3 || pose.speed < 0.15;
  return true;
}
