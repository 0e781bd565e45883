// A run that goes on: what comes is taken in, and the time shown keeps up with it unless somebody looks back.

const kMostSteps = 12e6;  // of all agents, about 300 MB: what is older is forgotten
let timelineDrawn = 0, legendFor = '';

function forgetOld() {
  let held = 0;
  for (const agent of agents) held += agent.length;
  if (held < kMostSteps) return;
  const cut = times.length >> 1;
  const kept = agents.filter(agent => agent.first + agent.length > cut);
  for (const agent of agents) if (agent.first + agent.length <= cut) recording.byId.delete(agent.id);
  agents.length = 0;
  for (const agent of kept) agents.push(agent);
  live.forgotten = cut;
}

live.changed = () => {
  readSpan();
  if (live.forgotten) begin = times[live.forgotten];
  $('scrub').min = begin; $('scrub').max = end;
  Object.assign(root.dataset, {steps: times.length, agents: agents.length, events: events.length});
  const now = performance.now();
  if (now - timelineDrawn > 1000 || live.over) {
    timelineDrawn = now;
    forgetOld();
    drawTimeline();
    const about = [events.length, agents.length].join();
    if (about !== legendFor) { legendFor = about; buildMarks(); listMarks(); buildLegend(); shownText = ''; }
  }
  showLive();
  dirty = true;
};

function showLive() {
  const button = $('live');
  button.hidden = !live.on;
  button.classList.toggle('on', live.chase && !live.over);
  button.textContent = live.over ? 'the run is over' : live.source.readyState === EventSource.OPEN ? '● live' : 'connection lost';
}

/// Most of the way to what came last within half a second: smooth at any pace of the run.
function chase(elapsed) {
  time = Math.max(time, time + (end - time) * (1 - Math.exp(-elapsed / 0.25)));
  if (end - time > 30) time = end;
}
