// SPDX-License-Identifier: MIT
// The page's side of docs/streams.md, with a socket and a worker that do nothing by themselves.
import assert from 'node:assert/strict';
import test, { beforeEach } from 'node:test';
import { WallStream } from '../../web-ui-min/stream.js';

let sockets, workers, timers, log;

class FakeSocket {
  static OPEN = 1;
  readyState = 0;
  sent = [];
  constructor(url) {
    this.url = url;
    sockets.push(this);
  }
  send(text) { this.sent.push(JSON.parse(text)); }
  open() {
    this.readyState = FakeSocket.OPEN;
    this.onopen();
  }
  close() {
    this.readyState = 3;
    this.onclose();
  }
  text(message) { this.onmessage({ data: JSON.stringify(message) }); }
  frame(part, sequence, time = 0) {
    const message = new ArrayBuffer(28), view = new DataView(message);
    view.setUint32(4, part, true);
    view.setBigUint64(8, BigInt(time), true);
    view.setUint32(16, sequence, true);
    view.setUint32(20, 1, true);
    view.setUint32(24, sequence, true);  // the packet
    this.onmessage({ data: message });
  }
}

class FakeWorker {
  posted = [];
  constructor() { workers.push(this); }
  postMessage(message) { this.posted.push(message); }
  get packets() { return this.posted.filter(({ packet }) => packet).map(({ packet }) => packet[0]); }
}

const kParts = {
  stream: 0, codec: 'huffyuv', layout: 'rgba', width: 64, height: 24, shows: [0, 0, 64, 24], background: '#000000',
  parts: [{ tile: 'A', rect: [0, 0, 32, 24], away: false }, { tile: 'B', rect: [32, 0, 32, 24], away: true }] };
const kHeader = { stream: 0, part: 0, header: 'AQID' };

function start() {
  const on = Object.fromEntries(['frame', 'ended', 'state', 'problem'].map(name =>
      [name, (...values) => log.push([name, ...values])]));
  return new WallStream('ws://wall/api/v1/stream', on);
}

/** Open, watching, with its parts told and the first one's header. */
function started() {
  const stream = start();
  sockets[0].open();
  sockets[0].text(kParts);
  sockets[0].text(kHeader);
  log = [];
  return stream;
}

beforeEach(() => {
  [sockets, workers, timers, log] = [[], [], [], []];
  Object.assign(globalThis, { WebSocket: FakeSocket, Worker: FakeWorker,
      setTimeout: (run, wait) => timers.push({ run, wait }) });
});

test('what was asked for before the connection is open is asked for then', () => {
  start().watch({ wall: true, width: 32, height: 24, fps: 10 });
  assert.deepEqual(sockets[0].sent, []);
  sockets[0].open();
  assert.deepEqual(sockets[0].sent, [{ watch: [{ wall: true, width: 32, height: 24, fps: 10, codec: 'huffyuv' }] }]);
  assert.deepEqual(log, [['state', true]]);
});

test('a frame goes to the worker and comes back as a picture of its tile', () => {
  started();
  assert.deepEqual(workers[0].posted, [{ part: 0, header: Uint8Array.of(1, 2, 3), width: 32, height: 24 }]);
  sockets[0].frame(0, 7, 5_000_000);
  assert.deepEqual(workers[0].packets, [7]);
  workers[0].onmessage({ data: { part: 0, bitmap: 'picture' } });
  assert.deepEqual(log, [['frame', 'A', 'picture', 5000]]);
});

test('while one is decoded, the newest of the others waits', () => {
  started();
  for (const sequence of [1, 2, 3, 4]) sockets[0].frame(0, sequence);
  assert.deepEqual(workers[0].packets, [1]);
  workers[0].onmessage({ data: { part: 0, bitmap: 'one' } });
  assert.deepEqual(workers[0].packets, [1, 4]);
  workers[0].onmessage({ data: { part: 0, bitmap: 'four' } });
  assert.deepEqual(workers[0].packets, [1, 4]);
});

test('a frame that waits does not meet the next parts or header', () => {
  started();
  for (const text of [kParts, kHeader]) {
    sockets[0].frame(0, 1);
    sockets[0].frame(0, 2);
    sockets[0].text(text);
  }
  workers[0].onmessage({ data: { part: 0, bitmap: 'one' } });
  assert.deepEqual(workers[0].packets, [1]);
});

test('a packet that cannot be decoded is said, and the stream goes on', () => {
  started();
  sockets[0].frame(0, 1);
  sockets[0].frame(0, 2);
  workers[0].onmessage({ data: { part: 0, error: 'huffyuv: too short' } });
  assert.deepEqual(log, [['problem', 'tile A: huffyuv: too short']]);
  assert.deepEqual(workers[0].packets, [1, 2]);
});

test('frames of unknown parts and cut ones are left alone', () => {
  started();
  sockets[0].frame(1, 1);
  sockets[0].frame(5, 1);
  sockets[0].text({ ...kHeader, part: 7 });
  sockets[0].onmessage({ data: new ArrayBuffer(23) });
  assert.deepEqual(workers[0].packets, []);
});

test('ends and errors are said', () => {
  started();
  sockets[0].text({ stream: 0, part: 0, ended: 'node left is away' });
  sockets[0].text({ error: "watch[1].tile: there is no tile 'B'" });
  sockets[0].text({ ...kParts, codec: 'zstd' });
  assert.deepEqual(log.slice(0, 2), [['ended', 'A', 'node left is away'],
      ['problem', "watch[1].tile: there is no tile 'B'"]]);
  assert.match(log[2][1], /zstd/);
});

test('it connects again, less and less often, and asks for the same', () => {
  const stream = start();
  stream.watch({ wall: true });
  const waits = [];
  for (let i = 0; i < 8; ++i) {
    sockets.at(-1).close();
    waits.push(timers[i].wait);
    timers[i].run();
    assert.equal(sockets.length, i + 2);
  }
  assert.ok(waits[0] >= 400 && waits[0] <= 600, `${waits}`);
  assert.ok(waits[7] >= 12000 && waits[7] <= 18000, `${waits}`);
  sockets.at(-1).open();
  assert.deepEqual(sockets.at(-1).sent, [{ watch: [{ wall: true, codec: 'huffyuv' }] }]);
});

test('a stream that has worked is tried again soon', () => {
  started();
  sockets[0].close();
  assert.deepEqual(log, [['state', false]]);
  assert.ok(timers[0].wait <= 600);
  timers[0].run();
  sockets[1].open();
  sockets[1].text(kParts);
  sockets[1].close();
  assert.ok(timers[1].wait <= 600, `${timers[1].wait}`);
});
