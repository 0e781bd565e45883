#!/usr/bin/env node
// Writes a recording of so many agents on the map of another one, each of which goes there and back along the way of one that
// was there: to measure the replay page with (tools/measure_replay.mjs) when no run has as many.
// usage: tools/made_recording.mjs FROM/replay.bin TO/replay.bin AGENTS SECONDS
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';
import {fileURLToPath} from 'node:url';

const [from, to, agents, seconds] = process.argv.slice(2);
if (!(seconds > 0)) {
  console.error('usage: tools/made_recording.mjs FROM/replay.bin TO/replay.bin AGENTS SECONDS');
  process.exit(2);
}
const page = path.join(path.dirname(fileURLToPath(import.meta.url)), '../src/io/replay/recording.js');
const {Decoder, inflate} = new Function(fs.readFileSync(page, 'utf8') + '; return {Decoder, inflate};')();
const decoder = new Decoder();
decoder.push(await inflate(fs.readFileSync(from)));
const ways = decoder.recording.agents.filter(agent => agent.length > 100);

let bytes = [];
const chunks = [];
const byte = value => bytes.push(value & 255);
const count = value => { while (value >= 128) { byte(value % 128 + 128); value = Math.floor(value / 128); } byte(value); };
const signed = value => count(value >= 0 ? 2 * value : -2 * value - 1);
const text = words => { const letters = Buffer.from(words); count(letters.length); for (const letter of letters) byte(letter); };

for (const letter of Buffer.from('SGR3')) byte(letter);
text(JSON.stringify(decoder.recording.map));
const made = Array.from({length: +agents}, (_, i) => ({way: ways[i % ways.length], begin: i * 37, x: 0, y: 0, dx: 0, dy: 0, h: 0}));
for (let step = 0; step < 10 * seconds; ++step) {
  byte(1); count(100); count(0); count(step ? 0 : made.length);
  if (!step) made.forEach(({way}, i) => {
    count(i); byte(way.type); text(way.name + '/' + i); byte(way.outline.length);
    for (const [x, y] of way.outline) { signed(Math.round(100 * x)); signed(Math.round(100 * y)); }
    count(1300); count(50); count(160); count(50); count(100); byte(1);
  });
  for (const agent of made) {
    const {way} = agent, at = (agent.begin + step) % (2 * way.length), k = at < way.length ? at : 2 * way.length - 1 - at;
    const x = Math.round(100 * way.x[k]), y = Math.round(100 * way.y[k]), h = Math.round(way.h[k] * 2048 / Math.PI);
    signed(x - agent.x - agent.dx); signed(y - agent.y - agent.dy); signed(h - agent.h);
    byte(way.state[k] & 127); byte(way.bind[k]);
    Object.assign(agent, {dx: x - agent.x, dy: y - agent.y, x, y, h});
  }
  if (bytes.length > 1 << 20) { chunks.push(Buffer.from(bytes)); bytes = []; }
}
byte(0);
chunks.push(Buffer.from(bytes));
fs.mkdirSync(path.dirname(to), {recursive: true});
fs.writeFileSync(to, zlib.gzipSync(Buffer.concat(chunks)));
