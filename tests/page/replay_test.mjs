// The replay page's modules, those that need no browser. Run by ctest: node --test tests/page
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import {fileURLToPath} from 'node:url';

const folder = path.join(path.dirname(fileURLToPath(import.meta.url)), '../../src/io/replay');

/// What the scripts declare, as the page has it: one after the other in one function.
function load(names, wanted, given = '') {
  const source = names.map(name => fs.readFileSync(path.join(folder, name), 'utf8')).join('\n');
  return new Function(`'use strict'; ${given}\n${source}\n; return {${wanted.join()}};`)();
}

/// Writes what ReplayEncoder writes.
class Bytes {
  constructor() { this.list = []; }
  byte(value) { this.list.push(value & 255); return this; }
  count(value) { while (value >= 128) { this.byte(value % 128 + 128); value = Math.floor(value / 128); } return this.byte(value); }
  signed(value) { return this.count(value >= 0 ? 2 * value : -2 * value - 1); }
  text(text) { const bytes = Buffer.from(text); this.count(bytes.length); this.list.push(...bytes); return this; }
  header(title) { this.list.push(...Buffer.from('SGR3')); return this.text(JSON.stringify({title})); }
  newcomer(id, name) {
    this.count(id).byte(0).text(name).byte(4);
    for (const [x, y] of [[200, 90], [-200, 90], [-200, -90], [200, -90]]) this.signed(x).signed(y);
    return this.count(1300).count(50).count(200).count(50).count(110).byte(1);
  }
  pose(x, y, turn, state, bind) { return this.signed(x).signed(y).signed(turn).byte(state).byte(bind); }
  done() { return Uint8Array.from(this.list); }
}

const {Decoder, spaceAt, planAt} = load(['recording.js'], ['Decoder', 'spaceAt', 'planAt']);


test('poses are sums of second differences, foes stay until another follows', () => {
  const bytes = new Bytes().header('town');
  bytes.byte(1).count(100).count(0).count(1).newcomer(7, 'car.7').pose(1000, 500, 1024, 16, 0);
  // 10 cm on: its first step was of 10 m
  bytes.byte(1).count(100).count(0).count(0).signed(-990).signed(-500).signed(0).byte(16 | 5 | 128).count(4).byte(6 | 128).count(4);
  bytes.byte(1).count(100).count(0).count(0).pose(0, 0, 0, 16 | 5, 6);
  const decoder = new Decoder();
  decoder.push(bytes.done());
  const {agents: [agent], times, alive} = decoder.recording;
  assert.deepEqual(times, [0.1, 0.2, 0.3]);
  assert.deepEqual(alive, [1, 1, 1]);
  assert.deepEqual([...agent.x.slice(0, 3)].map(x => Math.round(100 * x)), [1000, 1010, 1020]);
  assert.deepEqual([...agent.y.slice(0, 3)], [5, 5, 5]);
  assert.ok(Math.abs(agent.h[0] - Math.PI / 2) < 1e-6);
  assert.deepEqual([...agent.foe.slice(0, 3)], [-1, 3, 3]);
  assert.deepEqual([...agent.bind.slice(0, 3)], [0, 6, 6]);
  assert.equal(agent.behaviour.headway, 1.1);
  assert.equal(agent.front, 2);
});

test('a step that is cut off leaves those before it', () => {
  const whole = new Bytes().header('town');
  whole.byte(1).count(100).count(0).count(1).newcomer(7, 'car.7').pose(0, 0, 0, 16, 0);
  const kept = whole.list.length;
  whole.byte(1).count(100).count(0).count(1).newcomer(8, 'car.8').pose(0, 0, 0, 16, 0).pose(1, 1, 0, 16, 0);
  const bytes = whole.done();
  for (let size = kept; size < bytes.length; ++size) {
    const decoder = new Decoder();
    decoder.push(bytes.subarray(0, size));
    assert.equal(decoder.recording.times.length, 1, `cut to ${size}`);
    assert.equal(decoder.recording.agents.length, 1);
    assert.equal(decoder.recording.agents[0].length, 1);
  }
});

test('who begins again goes on where there is no gap, and is somebody else after one', () => {
  const step = (bytes, ms, id) => bytes.byte(1).count(ms).count(0).count(1).newcomer(id, 'car').pose(0, 0, 0, 16, 0);
  const decoder = new Decoder();
  decoder.push(step(new Bytes().header('town'), 100, 1).done());
  decoder.push(step(new Bytes().byte(5), 200, 1).done());
  assert.equal(decoder.recording.agents.length, 1);
  assert.equal(decoder.recording.agents[0].length, 2);
  decoder.push(step(new Bytes().byte(5), 300, 2).done());
  decoder.push(step(new Bytes().byte(5), 400, 1).done());
  assert.equal(decoder.recording.agents.length, 3);
  assert.deepEqual(decoder.recording.times, [0.1, 0.2, 0.3, 0.4]);
});

test('a mark that is told again takes the place of the first, and marks are in order of time', () => {
  const bytes = new Bytes().header('town');
  const event = (ms, words) => bytes.byte(3).byte(0).count(ms).signed(100).signed(-200).count(1).count(3).text(words);
  event(5000, '');
  event(3000, 'early');
  event(5000, '0.12 m deep');
  const decoder = new Decoder();
  decoder.push(bytes.done());
  assert.deepEqual(decoder.recording.events.map(e => [e.time, e.words]), [[3, 'early'], [5, '0.12 m deep']]);
  assert.deepEqual([decoder.recording.events[0].x, decoder.recording.events[0].y, decoder.recording.events[0].b], [1, -2, 2]);
});

test('another version is refused', () => {
  const bytes = Uint8Array.from(Buffer.from('SGR1\x02{}'));
  assert.throws(() => new Decoder().push(bytes), /version/);
});

test('a velocity space belongs to its step, and for a second to those after it', () => {
  const recording = {times: [0, 0.5, 1, 1.5, 2], spaces: new Map([[7, [{step: 1}, {step: 2}]]])};
  assert.equal(spaceAt(recording, 7, 0), null);
  assert.equal(spaceAt(recording, 7, 1).step, 1);
  assert.equal(spaceAt(recording, 7, 4).step, 2);
  recording.times[4] = 2.1;
  assert.equal(spaceAt(recording, 7, 4), null);
  assert.equal(spaceAt(recording, 8, 1), null);
});

test('a plan is read with its beliefs, scenarios and choices, and one that is cut off is left out', () => {
  const bytes = new Bytes().header('town');
  const line = (...points) => {
    bytes.count(points.length);
    points.forEach(([x, y], i) => bytes.signed(x - (points[i - 1]?.[0] ?? 0)).signed(y - (points[i - 1]?.[1] ?? 0)));
    return bytes;
  };
  const begin = bytes.list.length;
  bytes.byte(6).count(12350).count(7).byte(0).signed(-3000).signed(0);
  line();
  bytes.byte(1).count(2).signed(3000).byte(0).signed(-3000).byte(1).signed(-21250).signed(-3000);
  bytes.count(1).count(9).count(2).count(750);
  line([1000, -500], [2000, -510]).count(250);
  line([1000, -500]);
  bytes.count(1).count(2).count(9).count(2);
  line().count(7).count(0);
  line([0, 0], [100, 0]);
  const end = bytes.list.length;
  const decoder = new Decoder();
  decoder.push(bytes.done());
  assert.deepEqual(decoder.recording.plans, [{
    time: 12.35, ego: 7, action: 0, acceleration: -3, steering: 0, trajectory: [], figures: 1,
    choices: [{acceleration: 3}, {acceleration: -3, lower: -21.25, upper: -3}],
    beliefs: new Map([[9, [{probability: 0.75, line: [[10, -5], [20, -5.1]]}, {probability: 0.25, line: [[10, -5]]}]]]),
    scenarios: [[{id: 9, way: 1, line: []}, {id: 7, way: -1, line: [[0, 0], [1, 0]]}]],
  }]);
  for (let size = begin; size < end; ++size) {
    const other = new Decoder();
    other.push(bytes.done().subarray(0, size));
    assert.equal(other.recording.plans.length, 0, `cut to ${size}`);
  }
});

test('a plan holds until the next one', () => {
  const plans = [{time: 1}, {time: 1.35}, {time: 1.7}];
  assert.equal(planAt(plans, 0.9), null);
  assert.equal(planAt(plans, 1), plans[0]);
  assert.equal(planAt(plans, 1.5), plans[1]);
  assert.equal(planAt(plans, 60), plans[2]);
  assert.equal(planAt([], 1), null);
});

const words = load(['words.js'], ['limitOf', 'limitWords', 'kLimits', 'kBind', 'kReason', 'kEvents', 'eventWords']);
const onRoad = reason => 16 | reason;

test('what holds an agent is said in words', () => {
  const {limitWords, kBind, kReason} = words;
  assert.equal(limitWords(onRoad(kReason.leader), kBind.road, 'bus.2'), 'follows bus.2');
  assert.equal(limitWords(onRoad(kReason.signal), kBind.road, ''), 'waits for a signal');
  // the leader is there, and isn't what binds
  assert.equal(limitWords(onRoad(kReason.leader), kBind.neighbour, 'pedestrian.1'), 'keeps clear of pedestrian.1');
  assert.equal(limitWords(onRoad(kReason.leader), kBind.none, ''), 'nothing holds it back');
  assert.equal(limitWords(onRoad(kReason.leader) | 32, kBind.none, ''), 'as SUMO decides');
});

test('every limit has a colour of its own group', () => {
  const {limitOf, kLimits, kBind, kReason} = words;
  assert.equal(kLimits[limitOf(onRoad(kReason.signal), kBind.road)], 'signal');
  assert.equal(kLimits[limitOf(onRoad(kReason.letsIn), kBind.road)], 'gives way');
  assert.equal(kLimits[limitOf(onRoad(kReason.leader), kBind.none)], 'free');
  assert.equal(kLimits[limitOf(onRoad(kReason.leader) | 32, kBind.road)], 'not known');
  for (const bind of Object.values(kBind)) for (const reason of Object.values(kReason))
    assert.ok(limitOf(onRoad(reason), bind) in kLimits);
});

test('a mark names who took part', () => {
  const nameOf = id => 'car.' + id;
  assert.equal(words.eventWords({a: 1, b: 2, words: 'crossing'}, nameOf), 'car.1 and car.2: crossing');
  assert.equal(words.eventWords({a: 1, b: -1, words: ''}, nameOf), 'car.1');
});

const {openingStep, densestPlace} = load(['opening.js'], ['openingStep', 'densestPlace']);

test('the page begins once half of the usual traffic is there', () => {
  assert.equal(openingStep([0, 0, 10, 49, 50, 100, 100, 100, 100, 100]), 4);
  assert.equal(openingStep([0, 0, 0, 0, 1]), 4);
  assert.equal(openingStep([3, 3, 3]), 0);
  assert.equal(openingStep([]), 0);
});

test('the page begins where most are', () => {
  const xs = [0, 1000, 1001, 1002, -500], ys = [0, 400, 401, 402, 20];
  const place = densestPlace(xs, ys, 300, 200);
  assert.equal(place.count, 3);
  assert.ok(Math.abs(place.x - 1001) < 80 && Math.abs(place.y - 401) < 50);
  assert.equal(densestPlace([], [], 300, 200), null);
});

const space = load(['space.js'], ['borderIn', 'slackOf', 'planesByWeight'], 'const kPlaneKinds = [];');

test('borders are drawn where the model has its half-planes', () => {
  // v.x <= 3 for an agent that points east, whose ahead is up
  const plane = {normal: [-1, 0], offset: -3};
  const border = space.borderIn(plane, 5, 0);
  for (const end of [border.from, border.to]) assert.ok(Math.abs(end[1] - 3) < 1e-9 && Math.abs(Math.abs(end[0]) - 4) < 1e-9);
  assert.equal(space.borderIn(plane, 2, 0), null);
  assert.equal(space.slackOf(plane, [1, 7]), 2);
  assert.equal(space.slackOf(plane, [4, 0]), -1);
});

test('the plane that binds comes first, then the nearest', () => {
  const planes = [{normal: [1, 0], offset: -9, kind: 0}, {normal: [1, 0], offset: -1, kind: 1}, {normal: [1, 0], offset: -5, kind: 1}];
  const order = space.planesByWeight({planes, plane: 2, chosen: [0, 0]}).map(plane => plane.offset);
  assert.deepEqual(order, [-5, -1, -9]);
});

const plans = load(['words.js', 'plans.js'], ['turnOf', 'lineOf', 'apart', 'planLines', 'wayWords', 'planWords', 'figureWords'],
  'const clockText = t => t.toFixed(1);');

test('ways are told by where they end up against where the agent points', () => {
  const {turnOf, wayWords} = plans, north = Math.PI / 2;
  const told = (line, h) => wayWords(turnOf(line, h));
  assert.equal(told([[0, 0]], 0), 'stops');
  assert.equal(told([[0, 0], [0, 10], [0, 20]], north), 'goes on');
  assert.equal(told([[0, 0], [0, 10], [-10, 20], [-20, 20], [-20, 20]], north), 'turns left');
  assert.equal(told([[0, 0], [0, 10], [10, 20], [20, 20]], north), 'turns right');
  assert.equal(told([[0, 0], [0, -10]], north), 'turns back');
  // across the seam of angles
  assert.equal(told([[0, 0], [-10, 0]], -Math.PI + 0.1), 'goes on');
});

test('of the ego its choices are told, of others what is believed of them', () => {
  const plan = {ego: 7, acceleration: -3, figures: 1, choices: [{acceleration: 0}, {acceleration: -3, lower: -21.25, upper: -812.4}],
    beliefs: new Map([[9, [{probability: 0.756, line: [[0, 0], [5, 0]]}, {probability: 0.244, line: [[0, 0]]}]]])};
  assert.deepEqual(plans.planLines(plan, 7, 0), [
    {mark: '○', text: 'keeps its speed', value: 'not looked at', share: 0, bold: false},
    {mark: '●', text: 'brakes by 3.0 m/s²', value: '-21.25 … -812', share: 0, bold: true}]);
  assert.deepEqual(plans.planLines(plan, 9, 0), [
    {mark: 1, text: 'goes on', value: '76 %', share: 0.756, bold: false},
    {mark: 2, text: 'stops', value: '24 %', share: 0.244, bold: false}]);
  assert.deepEqual(plans.planLines(plan, 8, 0), []);
  assert.equal(plans.figureWords(2, {lower: 1 / 9}), '11 %');
  assert.equal(plans.planWords({time: 3, action: 1, acceleration: 1, steering: -0.2}), 'plan of 3.0: speeds up by 1.0 m/s², front wheels 11° right');
});

test('numbers at ends that coincide are side by side', () => {
  const placed = plans.apart([[10, 10], [11, 10], [10, 10], [80, 10]], 16);
  assert.deepEqual([placed[0], placed[3]], [[10, 10], [80, 10]]);
  for (const [i, [x, y]] of placed.entries()) for (const [u, v] of placed.slice(0, i)) assert.ok(Math.hypot(x - u, y - v) >= 16);
});

test('in a scenario everybody goes along one of its ways, or as was predicted', () => {
  const plan = {beliefs: new Map([[9, [{line: [[0, 0]]}, {line: [[1, 1]]}]]])};
  assert.deepEqual(plans.lineOf(plan, {id: 9, way: 1, line: []}), [[1, 1]]);
  assert.deepEqual(plans.lineOf(plan, {id: 9, way: -1, line: [[2, 2]]}), [[2, 2]]);
  assert.deepEqual(plans.lineOf(plan, {id: 5, way: 0, line: []}), []);
});
