// SPDX-License-Identifier: MIT
// What the page concludes from walld's status, and its arithmetic of rectangles.
import assert from 'node:assert/strict';
import test from 'node:test';
import { moved, resized, scaledRect, touch } from '../../web-ui-min/geometry.js';
import { mayChange, mayOperate, Rates, tileSkew, tileState, trafficOf, windowsOf } from '../../web-ui-min/model.js';

const canvas = { width: 640, height: 480 };

test('a moved window keeps some of itself on the canvas', () => {
  assert.deepEqual(moved([10, 20, 100, 50], 5, -7, canvas), [15, 13, 100, 50]);
  assert.deepEqual(moved([10, 20, 100, 50], 5000, 5000, canvas), [608, 448, 100, 50]);
  assert.deepEqual(moved([10, 20, 100, 50], -5000, -5000, canvas), [-68, -18, 100, 50]);
});

test('a window smaller than what stays in sight stays on the canvas', () => {
  assert.deepEqual(moved([10, 20, 16, 16], -5000, 5000, canvas), [0, 448, 16, 16]);
});

test('a resized window stays a window', () => {
  assert.deepEqual(resized([10, 20, 100, 50], 5, 6, canvas), [10, 20, 105, 56]);
  assert.deepEqual(resized([10, 20, 100, 50], -500, -500, canvas), [10, 20, 16, 16]);
  assert.deepEqual(resized([10, 20, 100, 50], 1e6, 1e6, canvas), [10, 20, 1280, 960]);
});

test('scaled neighbours neither overlap nor gape', () => {
  for (const picture of [canvas, { width: 320, height: 240 }, { width: 237, height: 178 }, { width: 8, height: 6 }]) {
    const left = scaledRect([0, 0, 101, 33], canvas, picture), right = scaledRect([101, 0, 77, 33], canvas, picture);
    assert.equal(left[0] + left[2], right[0]);
    assert.equal(right[0] + right[2], Math.round(178 * picture.width / canvas.width));
  }
});

test('windows that only share an edge do not touch', () => {
  assert.ok(touch([0, 0, 10, 10], [9, 9, 5, 5]));
  assert.ok(!touch([0, 0, 10, 10], [10, 0, 5, 5]));
});

test('operators change all windows, users their own, viewers none', () => {
  const alice = { kind: 'user', name: 'alice', role: 'user' }, session = { owner: { kind: 'user', name: 'alice' } };
  assert.ok(mayChange(alice, session));
  assert.ok(!mayChange({ ...alice, name: 'bob' }, session));
  assert.ok(!mayChange({ ...alice, kind: 'token' }, session));
  assert.ok(!mayChange({ ...alice, role: 'viewer' }, session));
  assert.ok(mayChange({ kind: 'token', name: 'desk', role: 'operator' }, session));
  assert.ok(!mayChange(undefined, session));
  assert.ok(!mayOperate(alice) && mayOperate({ role: 'operator' }));
});

test('windows keep their order when they are raised', () => {
  const session = (id, ...surfaces) => ({ id, program: 'p', name: '',
      surfaces: surfaces.map(surface => ({ id: `${id}.${surface}`, title: '' })) });
  assert.deepEqual(windowsOf({ sessions: [session(10, 3), session(2, 30, 4)] }).map(({ id }) => id),
      ['2.4', '2.30', '10.3']);
});

test("a program's traffic is the sum of its kinds", () => {
  const traffic = { frames: 3, state_bytes_per_second: 10, object_bytes_per_second: 20, geometry_bytes_per_second: 300,
      frame_bytes: 33 };
  assert.deepEqual(trafficOf({ traffic }), { state: 10, object: 20, geometry: 300, frame: 33, all: 330 });
  assert.equal(trafficOf({}), undefined, 'an older walld');
});

// ---- statuses over time ----

const tile = { name: 'A', node: 'left', rect: [0, 0, 320, 240], up: true };
const statusOf = (frame, nodeFrames) => ({
  nodes: [{ name: 'left', up: true, frames: nodeFrames, bytes_received: 1000 * nodeFrames }], tiles: [tile],
  sessions: [{ id: 1, program: 'gears', name: '', surfaces: [{ id: '1.1', title: '', rect: [300, 200, 50, 50], frame,
      skew: { presented: { frames: frame, last_ms: 2 } } }] }] });

/** One status a second. */
function after(...frames) {
  const rates = new Rates();
  frames.forEach(([frame, nodeFrames], second) => rates.add(statusOf(frame, nodeFrames), 1000 * second));
  return rates;
}

test('rates are those of the last three seconds', () => {
  const rates = after([0, 0], [1000, 1000], [1010, 1020], [1020, 1040], [1030, 1060]);
  assert.equal(rates.frames.get('1.1').perSecond, 10);
  assert.equal(rates.nodeFrames.get('left').perSecond, 20);
  assert.equal(rates.nodeBytes.get('left').perSecond, 20000);
});

test('a counter that begins anew has no negative rate', () => {
  const rates = after([10, 5000], [20, 3]);
  assert.equal(rates.nodeFrames.get('left').perSecond, undefined);
});

test('what has ended is forgotten', () => {
  const rates = after([1, 1]);
  rates.add({ ...statusOf(2, 2), sessions: [] }, 1000);
  assert.equal(rates.frames.size, 0);
});

test('a tile is late when its window goes on and its node does not', () => {
  const windows = windowsOf(statusOf(0, 0));
  assert.equal(tileState(tile, windows, after([1, 7], [2, 7], [3, 7], [4, 7])), 'late');
  assert.equal(tileState(tile, windows, after([1, 7], [2, 7], [3, 7], [4, 8])), 'up');
  assert.equal(tileState(tile, windows, after([1, 7], [1, 7], [1, 7], [1, 7])), 'up', 'nothing moves');
  assert.equal(tileState(tile, windows, after([1, 7], [2, 7])), 'up', 'too early to tell');
  assert.equal(tileState({ ...tile, up: false }, windows, after([1, 7])), 'away');
  assert.equal(tileState({ ...tile, rect: [400, 0, 320, 240] }, windows, after([1, 7], [2, 7], [3, 7], [4, 7])), 'up',
      'the window is elsewhere');
});

test("a tile's skew is the greatest of its windows", () => {
  assert.equal(tileSkew(tile, windowsOf(statusOf(3, 3))), 2);
  assert.equal(tileSkew(tile, windowsOf(statusOf(0, 3))), undefined, 'nothing was shown yet');
});
