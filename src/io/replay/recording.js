// Reads a recording written by ReplayRecorder (its layout stands in src/io/replay.cpp).

async function inflate(text) {
  const packed = atob(text.trim());
  const bytes = new Uint8Array(packed.length);
  for (let i = 0; i < packed.length; ++i) bytes[i] = packed.charCodeAt(i);
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
    if (this.at >= this.bytes.length) throw new RangeError('end of recording');
    return this.bytes[this.at++];
  }
  count() {
    let value = 0, scale = 1;
    for (;;) {
      const byte = this.byte();
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

function decode(bytes) {
  const reader = new Reader(bytes);
  if (String.fromCharCode(...bytes.subarray(0, 4)) !== 'SGR1') throw new Error('not a recording');
  reader.at = 4;
  const recording = {map: JSON.parse(reader.text()), times: [], agents: [], signals: [], events: []};
  let alive = [], time = 0;
  const readAgent = first => {
    const agent = {id: reader.count(), type: reader.byte(), external: reader.byte() === 1, name: reader.text(), first,
      outline: [], x: [], y: [], h: [], why: [], at: [0, 0, 0, 0, 0]};
    for (let corners = reader.byte(); corners > 0; --corners) agent.outline.push([reader.signed() / 100, reader.signed() / 100]);
    return agent;
  };
  const readStep = () => {
    const elapsed = reader.count();
    let index = 0;
    const gone = new Set();
    for (let n = reader.count(); n > 0; --n) { index += reader.count(); gone.add(index); }
    if (gone.size) alive = alive.filter((_, i) => !gone.has(i));
    const step = recording.times.length;
    for (let n = reader.count(); n > 0; --n) {
      const agent = readAgent(step);
      recording.agents.push(agent);
      alive.push(agent);
    }
    for (const agent of alive) {
      const at = agent.at;
      at[2] += reader.signed(); at[3] += reader.signed();
      at[0] += at[2]; at[1] += at[3];
      at[4] += reader.signed();
      const why = reader.byte();
      agent.x.push(at[0] / 100); agent.y.push(at[1] / 100); agent.h.push(at[4] * kTurn); agent.why.push(why);
    }
    time += elapsed / 1000;
    recording.times.push(time);
  };
  const readSignals = () => {
    for (let n = reader.count(); n > 0; --n) {
      const signal = reader.count();
      (recording.signals[signal] ||= []).push({step: recording.times.length, state: reader.text()});
    }
  };
  const readEvent = () => {
    const kind = reader.byte(), ms = reader.count();
    recording.events.push({kind, time: ms / 1000, x: reader.signed() / 100, y: reader.signed() / 100,
      a: reader.count(), b: reader.count() - 1});
  };
  try {
    for (;;) {
      const record = reader.byte();
      if (record === 0) break;
      if (record === 1) readStep();
      else if (record === 2) readSignals();
      else if (record === 3) readEvent();
      else throw new Error('unknown record ' + record);
    }
  } catch (error) {
    if (!(error instanceof RangeError)) throw error;
  }
  finish(recording);
  return recording;
}

/// Typed arrays, sizes and names by id.
function finish(recording) {
  const byId = new Map();
  for (const agent of recording.agents) {
    agent.length = Math.min(agent.x.length, agent.y.length, agent.h.length, agent.why.length);
    agent.x = Float64Array.from(agent.x); agent.y = Float64Array.from(agent.y);
    agent.h = Float32Array.from(agent.h); agent.why = Uint8Array.from(agent.why);
    const xs = agent.outline.map(p => p[0]), ys = agent.outline.map(p => p[1]);
    agent.front = Math.max(...xs); agent.back = Math.min(...xs);
    agent.left = Math.max(...ys); agent.right = Math.min(...ys);
    agent.box = agent.outline.length === 4;
    byId.set(agent.id, agent);
  }
  recording.agents = recording.agents.filter(agent => agent.length > 0);
  recording.byId = byId;
  recording.alive = new Uint32Array(recording.times.length);
  for (const agent of recording.agents)
    for (let k = 0; k < agent.length; ++k) ++recording.alive[agent.first + k];
  recording.events.sort((a, b) => a.time - b.time);
}
