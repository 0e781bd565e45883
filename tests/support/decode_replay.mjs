// A recording as the replay page reads it, as JSON on stdout: for tests of who writes it.
// usage: node decode_replay.mjs PROJECT_FOLDER FILE   (packed by gzip or not)
import fs from 'node:fs';
import path from 'node:path';

const [root, file] = process.argv.slice(2);
const source = fs.readFileSync(path.join(root, 'src/io/replay/recording.js'), 'utf8');
const {Decoder, inflate} = new Function(source + '; return {Decoder, inflate};')();
let bytes = fs.readFileSync(file);
if (bytes[0] === 0x1f) bytes = await inflate(bytes);
const decoder = new Decoder();
decoder.push(new Uint8Array(bytes));
const {map, times, alive, agents, signals, events, spaces, plans} = decoder.recording;
const list = (column, agent) => [...column.slice(0, agent.length)];
console.log(JSON.stringify({
  title: map.title, ended: decoder.ended, times, alive, signals, events, spaces: Object.fromEntries(spaces),
  plans: plans.map(plan => ({...plan, beliefs: Object.fromEntries(plan.beliefs)})),
  agents: agents.map(agent => ({id: agent.id, name: agent.name, type: agent.type, first: agent.first, length: agent.length,
    outline: agent.outline, behaviour: agent.behaviour, x: list(agent.x, agent), y: list(agent.y, agent), h: list(agent.h, agent),
    state: list(agent.state, agent), foe: list(agent.foe, agent), bind: list(agent.bind, agent), bindFoe: list(agent.bindFoe, agent)})),
}));
