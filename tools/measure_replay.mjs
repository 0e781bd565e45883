#!/usr/bin/env node
// How fast a replay page is in a headless browser: bytes, seconds until it plays, frames a second, the longest frames.
// usage: tools/measure_replay.mjs PAGE.html [SECONDS] [LINK, as "t=300&s=2&paths=1"]
// BROWSER=firefox (Debian's firefox-esr) instead of Chromium; PICTURE=FILE.png keeps what the page showed in the end.
import {spawn} from 'node:child_process';
import fs from 'node:fs';
import net from 'node:net';
import os from 'node:os';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const [page, seconds = '10', link = ''] = process.argv.slice(2);
if (!page) {
  console.error('usage: tools/measure_replay.mjs PAGE.html [SECONDS] [LINK]');
  process.exit(2);
}
const pause = milliseconds => new Promise(done => setTimeout(done, milliseconds));
const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'measure-replay-'));
const browser = await (process.env.BROWSER === 'firefox' ? firefox() : chromium());
try {
  const start = performance.now();
  await browser.open(pathToFileURL(page) + (link ? '#' + link : ''));
  while (await browser.evaluate('document.documentElement?.dataset.state') !== 'ready') await pause(20);
  const load = (performance.now() - start) / 1000;
  const frames = await browser.evaluate(`new Promise(done => {
    const times = [];
    const step = now => { times.push(now); if (now - times[0] < ${1000 * seconds}) requestAnimationFrame(step); else done(times); };
    requestAnimationFrame(step);
  })`);
  const lengths = frames.slice(1).map((time, i) => time - frames[i]).sort((a, b) => a - b);
  const shown = await browser.evaluate('[document.documentElement.dataset.agents, document.documentElement.dataset.steps, document.getElementById("alive").textContent].join()');
  const [agents, steps, alive] = shown.split(',');
  console.log(`${(fs.statSync(page).size / 1e6).toFixed(2)} MB, ${agents} agents, ${steps} steps; plays after ${load.toFixed(2)} s; ` +
    `${(1000 * lengths.length / (frames.at(-1) - frames[0])).toFixed(1)} frames/s with ${alive}, 99 % of them within ` +
    `${lengths[Math.floor(0.99 * lengths.length)].toFixed(1)} ms`);
  if (process.env.PICTURE) fs.writeFileSync(process.env.PICTURE, Buffer.from(await browser.picture(), 'base64'));
} finally {
  await browser.close();
  fs.rmSync(profile, {recursive: true, force: true});
}

// Through a pipe, by the protocol of its developer tools.
async function chromium() {
  const words = ['--headless', '--remote-debugging-pipe', `--user-data-dir=${profile}`, '--disable-gpu', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync', '--window-size=1280,800', 'about:blank'];
  if (process.getuid() === 0) words.push('--no-sandbox');
  const program = spawn('chromium', words, {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
  const [, , , to, from] = program.stdio;
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
  // the page that is in front: others aren't drawn
  let targetId;
  while (!targetId) targetId = (await ask('Target.getTargets')).targetInfos.find(target => target.type === 'page')?.targetId;
  session = (await ask('Target.attachToTarget', {targetId, flatten: true})).sessionId;
  return {
    open: url => ask('Page.navigate', {url}),
    evaluate: async expression =>
      (await ask('Runtime.evaluate', {expression, returnByValue: true, awaitPromise: true})).result?.value,
    picture: async () => (await ask('Page.captureScreenshot')).data,
    close: async () => {
      await ask('Browser.close');
      await new Promise(done => program.on('exit', done));
    },
  };
}

// Through a port of this machine that it chooses itself, by its Marionette protocol; errors of the page go to stderr.
async function firefox() {
  const settings = ['"marionette.port", 0', '"browser.shell.checkDefaultBrowser", false', '"app.update.enabled", false',
    '"datareporting.policy.dataSubmissionEnabled", false', '"network.captive-portal-service.enabled", false'];
  fs.writeFileSync(path.join(profile, 'user.js'), settings.map(words => `user_pref(${words});\n`).join(''));
  const program = spawn('firefox-esr', ['--headless', '--marionette', '--no-remote', '--profile', profile, '--width', '1280', '--height', '800'],
    {stdio: ['ignore', 'ignore', 'pipe'], env: {...process.env, MOZ_HEADLESS_WIDTH: '1280', MOZ_HEADLESS_HEIGHT: '800'}});
  program.stderr.on('data', bytes => {
    for (const line of String(bytes).split('\n')) if (line.startsWith('JavaScript error: file:')) console.error(line);
  });
  const noted = path.join(profile, 'MarionetteActivePort');
  for (let tries = 0; !fs.existsSync(noted) || !fs.readFileSync(noted, 'utf8'); ++tries) {
    if (tries > 600 || program.exitCode !== null) throw new Error('firefox-esr does not start');
    await pause(100);
  }
  const socket = net.connect(+fs.readFileSync(noted, 'utf8'), '127.0.0.1');
  const waiting = new Map();
  let asked = 0, rest = Buffer.alloc(0);
  socket.on('data', bytes => {
    rest = Buffer.concat([rest, bytes]);
    for (let colon; (colon = rest.indexOf(':')) > 0; ) {
      const end = colon + 1 + Number(rest.subarray(0, colon));
      if (rest.length < end) return;
      const message = JSON.parse(rest.subarray(colon + 1, end));
      rest = rest.subarray(end);
      if (Array.isArray(message)) waiting.get(message[1])?.(message);  // the first one is a greeting
    }
  });
  const ask = (method, params = {}) => new Promise((done, fail) => {
    waiting.set(++asked, ([, , error, result]) => error ? fail(new Error(`${method}: ${error.message}`)) : done(result));
    const text = Buffer.from(JSON.stringify([0, asked, method, params]));
    socket.write(Buffer.concat([Buffer.from(text.length + ':'), text]));
  });
  await ask('WebDriver:NewSession', {capabilities: {alwaysMatch: {timeouts: {script: 600000, pageLoad: 600000}}}});
  return {
    open: url => ask('WebDriver:Navigate', {url}),
    evaluate: async expression => (await ask('WebDriver:ExecuteAsyncScript',
      {script: `const done = arguments[0]; Promise.resolve(${expression}).then(done);`, args: []})).value,
    picture: async () => (await ask('WebDriver:TakeScreenshot', {full: false})).value,
    close: async () => {
      const gone = new Promise(done => program.on('exit', done));
      await ask('Marionette:Quit', {flags: ['eForceQuit']});
      await gone;
    },
  };
}
