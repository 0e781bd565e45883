// Reads the records that ReplayEncoder makes (their layout stands in src/io/replay_stream.cpp).

/// Bytes of base64.
function bytesOf(text) {
  const packed = atob(text.trim());
  const bytes = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; ++i) bytes[i] = packed.charCodeAt(i);
  return bytes;
}

/// What gzip packed; of a file that was cut off as much as there is.
async function inflate(bytes) {
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip')).getReader();
  const chunks = [];
  let size = 0;
  try {
    for (;;) {
      const {done, value} = await reader.read();
      if (done) break;
      chunks.push(value);
      size += value.length;
    }
  } catch (error) {
    // a run that was killed leaves no end: what is there is shown
    if (size === 0) throw error;
  }
  const all = new Uint8Array(size);
  let at = 0;
  for (const chunk of chunks) { all.set(chunk, at); at += chunk.length; }
  return all;
}

class Reader {
  constructor(bytes) { this.bytes = bytes; this.at = 0; }
  byte() {
    const byte = this.bytes[this.at++];
    if (byte === undefined) throw new RangeError('end of recording');
    return byte;
  }
  count() {
    let byte = this.byte();
    if (byte < 128) return byte;
    let value = byte & 127, scale = 128;
    for (;;) {
      byte = this.byte();
      value += (byte & 127) * scale;
      if (byte < 128) return value;
      scale *= 128;
    }
  }
  signed() { const value = this.count(); return value % 2 ? -(value + 1) / 2 : value / 2; }
  text() {
    const size = this.count();
    if (this.at + size > this.bytes.length) throw new RangeError('end of recording');
    this.at += size;
    return new TextDecoder().decode(this.bytes.subarray(this.at - size, this.at));
  }
}

const kTurn = 2 * Math.PI / 4096;
const kRecord = {end: 0, step: 1, signals: 2, event: 3, spaces: 4, again: 5, plan: 6};

const kColumns = {x: Float32Array, y: Float32Array, h: Float32Array, state: Uint8Array, foe: Int32Array, bind: Uint8Array, bindFoe: Int32Array};
const kValues = 7;

/// One agent from the step `first` on: x, y [m], h [rad], state (LimitReason + 16 on a road + 32 * Control), foe of that,
/// bind (BindingKind), bindFoe, each by step.
class Agent {
  constructor(id, first) {
    Object.assign(this, {id, first, length: 0, outline: [], at: [0, 0, 0, 0, 0], lastFoe: -1, lastBindFoe: -1});
    for (const name in kColumns) this[name] = new kColumns[name](64);
  }
  /// The values of one step, kValues of them from `from` on, in order of the columns.
  add(values, from) {
    const k = this.length++;
    if (k === this.x.length)
      for (const name in kColumns) {
        const wider = new kColumns[name](2 * k);
        wider.set(this[name]);
        this[name] = wider;
      }
    this.x[k] = values[from]; this.y[k] = values[from + 1]; this.h[k] = values[from + 2];
    this.state[k] = values[from + 3]; this.foe[k] = values[from + 4];
    this.bind[k] = values[from + 5]; this.bindFoe[k] = values[from + 6];
  }
}

/// A recording that grows by what is pushed: whole records, the header first.
class Decoder {
  constructor() {
    this.recording = {map: null, times: [], alive: [], agents: [], byId: new Map(), signals: [], events: [], spaces: new Map(),
      plans: []};
    this.known = new Map();  // events by what they are about
    this.now = [];           // agents that are there
    this.values = new Float64Array(kValues * 256);  // of a step
    this.ms = 0;
    this.ended = false;
  }

  header(reader) {
    const magic = String.fromCharCode(...reader.bytes.subarray(reader.at, reader.at + 4));
    if (magic !== 'SGR3') throw new Error('not a recording of this version');
    reader.at += 4;
    this.recording.map = JSON.parse(reader.text());
  }

  /// Where the bytes end amid a record, what came before is kept.
  push(bytes) {
    const reader = new Reader(bytes);
    const read = {[kRecord.step]: this.step, [kRecord.signals]: this.signals, [kRecord.event]: this.event,
      [kRecord.spaces]: this.spaces, [kRecord.again]: this.again, [kRecord.plan]: this.plan};
    try {
      if (!this.recording.map) this.header(reader);
      while (reader.at < bytes.length && !this.ended) {
        const kind = reader.byte();
        if (kind === kRecord.end) this.ended = true;
        else if (read[kind]) read[kind].call(this, reader);
        else throw new Error('unknown record ' + kind);
      }
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
    }
  }

  newcomer(reader, step) {
    const id = reader.count();
    const before = this.recording.byId.get(id);
    // seen up to the last step: it goes on
    const goesOn = before && before.first + before.length === step;
    const agent = goesOn ? before : new Agent(id, step);
    agent.type = reader.byte();
    agent.name = reader.text();
    agent.outline = [];
    for (let corners = reader.byte(); corners > 0; --corners) agent.outline.push([reader.signed() / 100, reader.signed() / 100]);
    agent.behaviour = {speed: reader.count() / 100, responsibility: reader.count() / 100, ahead: reader.count() / 10,
      behind: reader.count() / 10, headway: reader.count() / 100, keepsRules: reader.byte() === 1};
    agent.at = [0, 0, 0, 0, 0];
    agent.lastFoe = agent.lastBindFoe = -1;
    const xs = agent.outline.map(p => p[0]), ys = agent.outline.map(p => p[1]);
    agent.front = Math.max(...xs); agent.back = Math.min(...xs);
    agent.left = Math.max(...ys); agent.right = Math.min(...ys);
    agent.box = agent.outline.length === 4;
    return {agent, goesOn};
  }

  step(reader) {
    const {times, alive, agents, byId} = this.recording, step = times.length;
    const ms = this.ms + reader.count();
    let index = 0;
    const gone = new Set();
    for (let n = reader.count(); n > 0; --n) { index += reader.count(); gone.add(index); }
    const now = gone.size ? this.now.filter((_, i) => !gone.has(i)) : this.now.slice(), fresh = [];
    for (let n = reader.count(); n > 0; --n) {
      const {agent, goesOn} = this.newcomer(reader, step);
      if (!goesOn) fresh.push(agent);
      now.push(agent);
    }
    if (this.values.length < kValues * now.length) this.values = new Float64Array(2 * kValues * now.length);
    for (let i = 0; i < now.length; ++i) this.pose(reader, now[i], kValues * i);
    // the step is whole: now it counts
    this.ms = ms;
    this.now = now;
    for (const agent of fresh) { agents.push(agent); byId.set(agent.id, agent); }
    for (let i = 0; i < now.length; ++i) now[i].add(this.values, kValues * i);
    times.push(ms / 1000);
    alive.push(now.length);
  }

  pose(reader, agent, to) {
    const {at} = agent, {values} = this;
    at[2] += reader.signed(); at[3] += reader.signed();
    at[0] += at[2]; at[1] += at[3];
    at[4] += reader.signed();
    const state = reader.byte();
    if (state & 128) agent.lastFoe = reader.count() - 1;
    const bind = reader.byte();
    if (bind & 128) agent.lastBindFoe = reader.count() - 1;
    values[to] = at[0] / 100; values[to + 1] = at[1] / 100; values[to + 2] = at[4] * kTurn;
    values[to + 3] = state & 127; values[to + 4] = agent.lastFoe;
    values[to + 5] = bind & 127; values[to + 6] = agent.lastBindFoe;
  }

  signals(reader) {
    const {signals, times} = this.recording;
    for (let n = reader.count(); n > 0; --n) {
      const signal = reader.count(), state = reader.text(), list = signals[signal] ||= [];
      if (!list.length || list[list.length - 1].state !== state) list.push({step: times.length, state});
    }
  }

  event(reader) {
    const kind = reader.byte(), ms = reader.count();
    const event = {kind, time: ms / 1000, x: reader.signed() / 100, y: reader.signed() / 100, a: reader.count(),
      b: reader.count() - 1, words: reader.text()};
    const about = [kind, ms, event.a, event.b].join();
    const before = this.known.get(about);
    if (before) { Object.assign(before, event); return; }
    this.known.set(about, event);
    const {events} = this.recording;
    events.push(event);
    for (let i = events.length - 1; i > 0 && events[i - 1].time > event.time; --i) [events[i - 1], events[i]] = [events[i], events[i - 1]];
  }

  spaces(reader) {
    const {spaces, times} = this.recording, step = times.length - 1;
    const point = () => [reader.signed() / 1000, reader.signed() / 1000];
    for (let n = reader.count(); n > 0; --n) {
      const id = reader.count(), space = {step, velocity: point(), preferred: point(), answer: point(), chosen: point(),
        fastest: reader.count() / 1000, violation: reader.count() / 1000, binding: reader.byte(), plane: reader.count() - 1,
        hard: reader.count(), planes: []};
      for (let k = reader.count(); k > 0; --k) {
        const kind = reader.byte(), foe = reader.count() - 1, offset = reader.signed() / 1000, angle = reader.count() * 2 * Math.PI / 65536;
        space.planes.push({kind, foe, offset, normal: [Math.cos(angle), Math.sin(angle)]});
      }
      if (!spaces.has(id)) spaces.set(id, []);
      spaces.get(id).push(space);
    }
  }

  again() {
    this.now = [];
    this.ms = 0;
  }

  plan(reader) {
    const times = make => Array.from({length: reader.count()}, make);
    const line = () => {
      let x = 0, y = 0;
      return times(() => [(x += reader.signed()) / 100, (y += reader.signed()) / 100]);
    };
    const plan = {time: reader.count() / 1000, ego: reader.count(), action: reader.byte(), acceleration: reader.signed() / 1000,
      steering: reader.signed() / 1000, trajectory: line(), figures: reader.byte()};
    plan.choices = times(() => {
      const acceleration = reader.signed() / 1000;
      return reader.byte() ? {acceleration, lower: reader.signed() / 1000, upper: reader.signed() / 1000} : {acceleration};
    });
    plan.beliefs = new Map(times(() => [reader.count(), times(() => ({probability: reader.count() / 1000, line: line()}))]));
    plan.scenarios = times(() => times(() => ({id: reader.count(), way: reader.count() - 1, line: line()})));
    this.recording.plans.push(plan);
  }
}

/// The plan that holds at an instant: the last one before it; null before the first.
function planAt(plans, time) {
  let low = 0, high = plans.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (plans[middle].time <= time + 1e-9) low = middle + 1; else high = middle;
  }
  return low ? plans[low - 1] : null;
}

/// The velocity space of an agent at a step, or the last one up to a second before; null where there is none.
function spaceAt(recording, id, step) {
  const list = recording.spaces.get(id);
  if (!list) return null;
  let low = 0, high = list.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (list[middle].step <= step) low = middle; else high = middle - 1;
  }
  const found = list[low];
  return found.step <= step && recording.times[step] - recording.times[found.step] <= 1 ? found : null;
}
