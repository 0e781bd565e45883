// What happened when: counts, a list with words, and jumps.

/// Those from before the first step, which a viewer of a live run is told of too, have nothing to jump to.
const eventsHere = () => events.filter(event => event.time > begin - 1);

function buildMarks() {
  const box = $('marks');
  box.textContent = '';
  const all = eventsHere();
  kEvents.forEach((kind, i) => {
    const n = all.filter(event => event.kind === i).length;
    if (!n) return;
    const line = made('div', undefined, box), pin = made('canvas', undefined, line), link = made('a', undefined, line);
    line.classList.toggle('off', hiddenEvents.has(i));
    line.dataset.kind = i;
    pin.width = pin.height = 28;
    drawPin(pin.getContext('2d'), i, 14, 14, 9);
    pin.title = 'show or hide';
    pin.onclick = () => { hiddenEvents.has(i) ? hiddenEvents.delete(i) : hiddenEvents.add(i); buildMarks(); drawTimeline(); listMarks(); dirty = true; };
    made('em', n + ' ', link);
    link.append(n === 1 ? kind.name : kind.plural, ' ›');
    link.title = (kind.hint ? kind.hint + '; ' : '') + 'go to the next one';
    link.onclick = () => jumpToNext(1, i);
  });
  if (all.length) {
    const opener = made('a', $('list').hidden ? 'list ›' : 'hide the list', box, 'list');
    opener.onclick = toggleList;
  }
}

const shownEvents = () => eventsHere().filter(event => !hiddenEvents.has(event.kind));

function jumpTo(event) {
  live.chase = false;
  setPlaying(false);
  follow(null);
  seek(Math.min(event.time, end));
  view.x = event.x; view.y = event.y;
  view.scale = Math.max(view.scale, 9);
  view.changed = performance.now();
  marked = event;
  showMark();
}

/// The next mark in time, or the previous one (`way` -1), of this kind or of those shown.
function jumpToNext(way, kind) {
  const candidates = kind === undefined ? shownEvents() : eventsHere().filter(event => event.kind === kind);
  if (!candidates.length) return;
  const here = marked && Math.abs(Math.min(marked.time, end) - time) < 0.05 ? candidates.indexOf(marked) : -1;
  let index;
  if (here >= 0) index = here + way;
  else if (way > 0) index = candidates.findIndex(event => event.time > time + 0.05);
  else index = candidates.findLastIndex(event => event.time < time - 0.05);
  if (index < 0 || index >= candidates.length) index = way > 0 ? 0 : candidates.length - 1;
  jumpTo(candidates[index]);
}

let marked = null;
function showMark() {
  const box = $('mark');
  const shown = marked && Math.abs(time - Math.min(marked.time, end)) < 3;
  if (box.hidden !== !shown) box.hidden = !shown;
  if (!shown) { marked = null; box.dataset.about = ''; return; }
  const about = clockText(marked.time) + ' · ' + kEvents[marked.kind].name + ' · ' + eventWords(marked, nameOf);
  if (box.dataset.about === about) return;
  box.dataset.about = about;
  box.textContent = about;
  for (const id of [marked.a, marked.b]) {
    const agent = recording.byId.get(id);
    if (!agent) continue;
    const link = made('button', 'follow ' + agent.name, box);
    link.onclick = () => follow(agent);
  }
}

const kMostListed = 200;
function toggleList() {
  $('list').hidden = !$('list').hidden;
  buildMarks();
  listMarks();
}

/// Those about the present instant, as many as a list can bear.
function listMarks() {
  const list = $('list');
  if (list.hidden) return;
  list.textContent = '';
  const all = shownEvents();
  let from = all.findIndex(event => event.time >= time);
  from = Math.max(0, Math.min(from < 0 ? all.length : from, all.length - kMostListed / 2) - kMostListed / 2);
  const some = all.slice(from, from + kMostListed);
  if (some.length < all.length) made('p', `${some.length} of ${all.length}, those about ${clockText(time)}`, list);
  for (const event of some) {
    const item = made('button', undefined, list);
    made('b', clockText(event.time), item);
    made('em', kEvents[event.kind].name, item);
    made('span', eventWords(event, nameOf), item);
    item.onclick = () => jumpTo(event);
  }
}
