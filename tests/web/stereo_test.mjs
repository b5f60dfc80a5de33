// SPDX-License-Identifier: MIT
// What the page says about programs for two eyes, and what it asks walld for.
import assert from 'node:assert/strict';
import test from 'node:test';
import { hasEyes, kUsualSeparation, stereoText, wantedStereo } from '../../web-ui-min/stereo.js';

test('a wall with a tile for one eye has something to say of it', () => {
  assert.ok(!hasEyes([]));
  assert.ok(!hasEyes([{ eye: null }, { eye: null }]));
  assert.ok(hasEyes([{ eye: null }, { eye: 'right' }]));
});

test('a program says how far its eyes are apart, as wallctl does', () => {
  assert.equal(stereoText({ stereo: null }), undefined);
  assert.equal(stereoText({}), undefined, 'an older walld');
  assert.equal(stereoText({ stereo: { separation: 1.5, distance: 0 } }), 'stereo 1.5 %');
  assert.equal(stereoText({ stereo: { separation: 2.9999999, distance: 40 } }), 'stereo 3 % at 40');
  assert.equal(stereoText({ stereo: { separation: -1.25, distance: 1234.5 } }), 'stereo -1.25 % at 1230');
});

test('what the fields say is what walld is asked for', () => {
  assert.deepEqual(wantedStereo(true, '1.5', ''), { on: true, separation: kUsualSeparation, distance: 0 });
  assert.deepEqual(wantedStereo(true, ' -3 ', '40'), { on: true, separation: -3, distance: 40 });
  assert.deepEqual(wantedStereo(true, '25', '1e9'), { on: true, separation: 25, distance: 1e9 });
  assert.deepEqual(wantedStereo(false, 'x', '-1'), { on: false }, 'nobody reads them then');
});

test('fields that make no sense are not sent', () => {
  for (const separation of ['', ' ', 'x', '25.1', '-26', 'NaN'])
    assert.throws(() => wantedStereo(true, separation, ''), /Eyes apart: expected -25 to 25/, separation);
  for (const distance of ['-1', 'x', '2e9', 'Infinity'])
    assert.throws(() => wantedStereo(true, '1', distance), /Distance in the wall’s plane: expected 0 to/, distance);
});
