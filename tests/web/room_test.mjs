// SPDX-License-Identifier: MIT
// Where the plan of the room has its screens.
import assert from 'node:assert/strict';
import test from 'node:test';
import { screensOf } from '../../web-ui-min/room.js';

const edge = Math.tan(Math.PI / 8);
/** As the status has them: right, up, ahead, then the left, right, bottom and top edge. */
const upright = yaw =>
    [Math.cos(yaw), 0, -Math.sin(yaw), 0, 1, 0, Math.sin(yaw), 0, Math.cos(yaw), -edge, edge, -0.3, 0.3];
const near = (a, b) => a.forEach((value, i) => assert.ok(Math.abs(value - b[i]) < 1e-9, `${a} is not ${b}`));
const one = view => screensOf([{ name: 'a', state: 'up', view }])[0];

test('tiles without a view are not in the plan', () => {
  assert.deepEqual(screensOf([{ name: 'a', state: 'up', view: null }]), []);
});

test('ahead is up, and the right is on the right', () => {
  near(one(upright(0)).middle, [0, -1]);
  near(one(upright(Math.PI / 2)).middle, [1, 0]);
  near(one(upright(Math.PI)).middle, [0, 1]);
  near(one(upright(-Math.PI / 2)).middle, [-1, 0]);
});

test('an upright screen is a line from its left edge to its right one', () => {
  const [a, b, c, d] = one(upright(0)).corners;
  near(a, [-edge, -1]);
  near(b, [edge, -1]);
  near(c, b);
  near(d, a);
});

test('the screens of a ring meet at their edges', () => {
  const ring = screensOf([...Array(8).keys()]
      .map(i => ({ name: `${i}`, state: 'up', view: upright(i * Math.PI / 4) })));
  ring.forEach(({ corners }, i) => near(corners[1], ring[(i + 1) % 8].corners[0]));
});

test('a floor is a plane, and what is seen very aslant is cut', () => {
  const floor = one([1, 0, 0, 0, 0, 1, 0, -1, 0, -1, 1, -1, 1]);
  near(floor.corners[0], [-1, 1]);
  near(floor.corners[2], [1, -1]);
  const aslant = one([1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 50, -1, 1]);
  assert.ok(Math.hypot(...aslant.corners[1]) <= 2.5 + 1e-9);
});

test('people are told where each looks', () => {
  assert.equal(one(upright(0)).text, 'a looks ahead');
  assert.equal(one(upright(Math.PI / 4)).text, 'a looks 45° to the right');
  assert.equal(one(upright(-Math.PI / 2)).text, 'a looks 90° to the left');
  assert.equal(one([1, 0, 0, 0, 0, 1, 0, -1, 0, -1, 1, -1, 1]).text, 'a looks 90° down');
});
