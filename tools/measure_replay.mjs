#!/usr/bin/env node
// How fast a replay page is in headless Chromium: bytes, seconds until it plays, frames a second, the longest frame.
// usage: tools/measure_replay.mjs PAGE.html [SECONDS] [LINK, as "t=300&s=2&paths=1"]
import {spawn} from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const [page, seconds = '10', link = ''] = process.argv.slice(2);
if (!page) {
  console.error('usage: tools/measure_replay.mjs PAGE.html [SECONDS] [LINK]');
  process.exit(2);
}
const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'measure-replay-'));
const words = ['--headless', '--remote-debugging-pipe', `--user-data-dir=${profile}`, '--disable-gpu', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync', '--window-size=1280,800', 'about:blank'];
if (process.getuid() === 0) words.push('--no-sandbox');
const browser = spawn('chromium', words, {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
const [, , , to, from] = browser.stdio;
const waiting = new Map();
let asked = 0, session, rest = '';
from.on('data', bytes => {
  rest += bytes;
  const messages = rest.split('\0');
  rest = messages.pop();
  for (const message of messages.map(text => JSON.parse(text))) waiting.get(message.id)?.(message.result ?? message);
});
const ask = (method, params = {}) => new Promise(done => {
  waiting.set(++asked, done);
  to.write(JSON.stringify({id: asked, method, params, sessionId: session}) + '\0');
});
const evaluate = async expression =>
  (await ask('Runtime.evaluate', {expression, returnByValue: true, awaitPromise: true})).result?.value;

try {
  // the page that is in front: others aren't drawn
  let targetId;
  while (!targetId) targetId = (await ask('Target.getTargets')).targetInfos.find(target => target.type === 'page')?.targetId;
  session = (await ask('Target.attachToTarget', {targetId, flatten: true})).sessionId;
  const start = performance.now();
  await ask('Page.navigate', {url: pathToFileURL(page) + (link ? '#' + link : '')});
  while (await evaluate('document.documentElement?.dataset.state') !== 'ready') await new Promise(done => setTimeout(done, 20));
  const load = (performance.now() - start) / 1000;
  const frames = await evaluate(`new Promise(done => {
    const times = [];
    const step = now => { times.push(now); if (now - times[0] < ${1000 * seconds}) requestAnimationFrame(step); else done(times); };
    requestAnimationFrame(step);
  })`);
  const lengths = frames.slice(1).map((time, i) => time - frames[i]).sort((a, b) => a - b);
  const shown = await evaluate('[document.documentElement.dataset.agents, document.documentElement.dataset.steps, document.getElementById("alive").textContent].join()');
  const [agents, steps, alive] = shown.split(',');
  console.log(`${(fs.statSync(page).size / 1e6).toFixed(2)} MB, ${agents} agents, ${steps} steps; plays after ${load.toFixed(2)} s; ` +
    `${(1000 * lengths.length / (frames.at(-1) - frames[0])).toFixed(1)} frames/s with ${alive}, 99 % of them within ` +
    `${lengths[Math.floor(0.99 * lengths.length)].toFixed(1)} ms`);
} finally {
  await ask('Browser.close');
  await new Promise(done => browser.on('exit', done));
  fs.rmSync(profile, {recursive: true, force: true});
}
