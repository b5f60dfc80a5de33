// SPDX-License-Identifier: MIT
// What the page says about the wall, from walld's status: windows, who may change them, rates, and the state of tiles.
// Pure: the time is given.

import { touch } from './geometry.js';

const kRateWindow = 3000;  // ms that a rate is taken over
const kLateAfter = 2500;   // ms without a frame of a node that others have gone on for

/** All windows with what belongs to their session, in the order of their numbers, however they lie. */
export function windowsOf(status) {
  const windows = status.sessions.flatMap(session => session.surfaces.map(surface =>
      ({ ...surface, session, label: session.name || surface.title || session.program })));
  return windows.sort((a, b) => a.id.localeCompare(b.id, 'en', { numeric: true }));
}

/** As walld decides (docs/security.md): operators all, users their own. */
export function mayChange(who, session) {
  if (who?.role === 'operator') return true;
  return who?.role === 'user' && session.owner?.kind === who.kind && session.owner.name === who.name;
}
export const mayOperate = who => who?.role === 'operator';

/** How fast a counter grows. */
class Rate {
  #samples = [];
  add(time, value) {
    if (value < this.#samples.at(-1)?.value) this.#samples = [];  // it began anew
    this.#samples.push({ time, value });
    while (this.#samples.length > 2 && time - this.#samples[1].time >= kRateWindow) this.#samples.shift();
  }
  get span() { return this.#samples.at(-1).time - this.#samples[0].time; }
  get grown() { return this.#samples.at(-1).value - this.#samples[0].value; }
  /** Undefined until there are two samples. */
  get perSecond() { return this.span > 0 ? 1000 * this.grown / this.span : undefined; }
}

/** Rates of windows and nodes over the last statuses, by id and name. */
export class Rates {
  frames = new Map();      // of windows
  nodeFrames = new Map();
  nodeBytes = new Map();

  add(status, time) {
    this.#keep(this.frames, windowsOf(status), time, window => [window.id, window.frame]);
    this.#keep(this.nodeFrames, status.nodes, time, node => [node.name, node.frames]);
    this.#keep(this.nodeBytes, status.nodes, time, node => [node.name, node.bytes_received]);
  }
  #keep(rates, list, time, counter) {
    const counters = new Map(list.map(counter));
    for (const key of rates.keys()) if (!counters.has(key)) rates.delete(key);
    for (const [key, value] of counters) {
      if (!rates.has(key)) rates.set(key, new Rate());
      rates.get(key).add(time, value);
    }
  }
}

/** Bytes a second that a program sends to all nodes, in all and by kind; undefined where walld does not say. */
export function trafficOf({ traffic }) {
  if (!traffic) return undefined;
  const { state_bytes_per_second: state, object_bytes_per_second: object, geometry_bytes_per_second: geometry,
      frame_bytes: frame } = traffic;
  return { state, object, geometry, frame, all: state + object + geometry };
}

const windowsOn = (tile, windows) => windows.filter(window => touch(window.shown_rect ?? window.rect, tile.rect));

/** `late`: a window on it goes on, but its node has shown nothing for a while. */
export function tileState(tile, windows, rates) {
  if (!tile.up) return 'away';
  const own = rates.nodeFrames.get(tile.node);
  const goesOn = windowsOn(tile, windows).some(window => rates.frames.get(window.id)?.grown > 0);
  return goesOn && own && own.span >= kLateAfter && own.grown === 0 ? 'late' : 'up';
}

/** The greatest skew in ms of the windows on a tile; undefined without one that has shown frames together. */
export function tileSkew(tile, windows) {
  const skews = windowsOn(tile, windows).filter(window => window.skew?.presented.frames > 0)
      .map(window => window.skew.presented.last_ms);
  return skews.length ? Math.max(...skews) : undefined;
}
