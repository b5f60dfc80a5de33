// SPDX-License-Identifier: MIT
// The tables under the wall: programs, tiles, nodes.

import { get, rows } from './dom.js';
import { placeText } from './geometry.js';
import { trafficOf } from './model.js';
import { stereoText } from './stereo.js';

const kMissing = '–';
const number = (value, unit = '') =>
    value === undefined ? kMissing : `${value < 10 ? value.toFixed(1) : value.toFixed(0)}${unit}`;

function bytes(perSecond) {
  if (perSecond === undefined) return kMissing;
  return perSecond < 1e6 ? `${(perSecond / 1e3).toFixed(1)} kB/s` : `${(perSecond / 1e6).toFixed(1)} MB/s`;
}

function traffic(session) {
  const sent = trafficOf(session);
  if (!sent) return kMissing;
  const parts = `state ${bytes(sent.state)}, objects ${bytes(sent.object)}, geometry ${bytes(sent.geometry)}`;
  return { text: bytes(sent.all), title: `${parts}; ${Math.round(sent.frame)} bytes a frame` };
}

function age(ms) {
  if (ms === undefined) return kMissing;
  return ms < 10000 ? `${(ms / 1000).toFixed(1)} s` : `${(ms / 1000).toFixed(0)} s`;
}

function windowState({ session, moving, views, swap_timeouts: timeouts }) {
  const parts = [session.fault && `fault: ${session.fault}`, session.held && 'held', moving && 'moving',
      stereoText(session), views === 'flat' && 'shown flat: its camera is not known',
      timeouts > 0 && `frames that did not wait for a slow node: ${timeouts}`];
  return parts.filter(Boolean).join(', ') || 'runs';
}

/** `windows` and `tiles` as main.js joins them; `rates`: Rates of model.js. */
export function showTables({ status, windows, tiles, rates }, { onWindow, onTile }) {
  get('no-sessions').hidden = status.sessions.length > 0;
  rows(get('session-rows'), windows, window => window.id, [
    window => `${window.id} ${window.label}`,
    window => window.session.owner?.name || kMissing,
    window => placeText(window.rect),
    window => number(rates.frames.get(window.id)?.perSecond),
    window => traffic(window.session),
    window => number(window.skew?.presented.frames > 0 ? window.skew.presented.last_ms : undefined, ' ms'),
    windowState,
  ], onWindow);
  rows(get('tile-rows'), tiles, tile => tile.name, [
    tile => tile.name,
    tile => ({ text: tile.state === 'away' ? `away, node ${tile.node}` : tile.state, state: tile.state }),
    tile => placeText(tile.rect),
    tile => number(tile.up ? rates.nodeFrames.get(tile.node)?.perSecond : undefined),
    tile => number(tile.skew, ' ms'),
    tile => age(tile.age),
  ], onTile);
  rows(get('node-rows'), status.nodes, node => node.name, [
    node => node.name,
    node => ({ text: node.up ? `up, ${node.backend}` : 'away', state: node.up ? 'up' : 'away' }),
    node => node.renderer || kMissing,
    node => bytes(node.up ? rates.nodeBytes.get(node.name)?.perSecond : undefined),
    node => String(node.gl_errors),
  ]);
}
