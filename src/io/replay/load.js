// The page's parts, and the recording in it.

const $ = id => document.getElementById(id);
const root = document.documentElement;

let recording;
try {
  recording = decode(await inflate($('data').textContent));
  $('data').remove();
} catch (error) {
  $('notice').textContent = 'This page holds no readable recording: ' + error.message;
  root.dataset.state = 'error';
  return;
}
const {map, times, agents, events} = recording;
const begin = times.length ? times[0] : 0, end = times.length ? times[times.length - 1] : 0;
