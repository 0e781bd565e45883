// The page's parts, and the recording in it; or, where there is none, what its server tells.

const $ = id => document.getElementById(id);
const root = document.documentElement;
const decoder = new Decoder();
const recording = decoder.recording;
const live = {on: false, over: false, source: null, chase: false};

const packed = $('data').textContent.trim();
try {
  if (packed.startsWith('<!--')) await joinRun();
  else decoder.push(await inflate(bytesOf(packed)));
  $('data').remove();
} catch (error) {
  $('notice').textContent = 'This page holds no readable recording: ' + error.message;
  root.dataset.state = 'error';
  return;
}
const {map, times, agents, events} = recording;
let begin = 0, end = 0;
function readSpan() {
  begin = times.length ? times[0] : 0;
  end = times.length ? times[times.length - 1] : 0;
}
readSpan();

/// Comes back once there is something to show.
function joinRun() {
  live.on = live.chase = true;
  $('notice').textContent = 'Waiting for the run…';
  return new Promise(done => {
    live.source = new EventSource('events');
    live.source.addEventListener('header', e => {
      if (!recording.map) decoder.push(bytesOf(e.data));
      else if (JSON.stringify(recording.map) !== JSON.stringify(headerOf(e.data))) location.reload();
    });
    live.source.addEventListener('records', e => {
      decoder.push(bytesOf(e.data));
      if (recording.times.length) { done(); live.changed?.(); }
    });
    live.source.addEventListener('over', () => {
      live.source.close();
      live.over = true;
      done();
      live.changed?.();
    });
    live.source.onerror = () => {
      if (live.source.readyState === EventSource.CLOSED && !live.over)
        $('notice').textContent = 'As many viewers as there may be look at this run already.';
      live.changed?.();
    };
  });
}

function headerOf(text) {
  const other = new Decoder();
  other.push(bytesOf(text));
  return other.recording.map;
}
