// SPDX-License-Identifier: MIT
// Brings the wall's picture to life: a stream of it in the size that is shown, or pictures of the whole wall at
// intervals while there is no WebSocket; nothing while the tab is hidden or the picture is paused.

import { getSnapshot, streamUrl } from './api.js';
import { WallStream } from './stream.js';

const kRate = 10, kCalmRate = 1;  // frames a second; calm where the reader wants less motion
const kSnapshotEvery = 1500;      // ms
const kSizeStands = 200;              // ms that a new size must last before it is asked for

export class LivePicture {
  #picture; #stream; #live = false; #paused = false; #asked;
  #sizing;
  #calm = matchMedia('(prefers-reduced-motion: reduce)');
  taken = new Map();  // by tile: when its picture was taken, ms since 1970

  /** `picture`: WallPicture; `onState(live)`; `onProblem(text)`. */
  constructor(picture, onState, onProblem) {
    this.#picture = picture;
    this.#stream = new WallStream(streamUrl(), {
      frame: (tile, bitmap, taken) => {
        this.taken.set(tile, taken);
        picture.show(tile, bitmap);
      },
      ended: tile => {
        this.taken.delete(tile);
        picture.drop(tile);
      },
      state: live => {
        this.#setLive(live);
        onState(live);
      },
      problem: onProblem,
    });
    document.addEventListener('visibilitychange', () => this.refresh());
    this.#calm.addEventListener('change', () => this.refresh());
    this.#poll();
  }

  set paused(paused) {
    this.#paused = paused;
    this.refresh();
  }
  get #resting() { return this.#paused || document.hidden; }

  /** Asks for what the picture wants now, once its size stands. */
  refresh() {
    clearTimeout(this.#sizing);
    this.#sizing = setTimeout(() => this.#ask(), kSizeStands);
  }
  #ask() {
    const fps = this.#calm.matches ? kCalmRate : kRate;
    const wanted = this.#resting ? undefined : { wall: true, ...this.#picture.size, fps };
    const asked = JSON.stringify(wanted);
    if (asked === this.#asked) return;
    this.#asked = asked;
    this.#stream.watch(wanted);
  }

  #setLive(live) {
    this.#live = live;
    if (live) return this.#picture.showWall(undefined);
    this.#picture.dropTiles();
    this.taken.clear();
  }

  async #poll() {
    if (!this.#live && !this.#resting) {
      const wall = await getSnapshot().catch(() => undefined);  // what is wrong, the status says
      if (wall && !this.#live) this.#picture.showWall(wall);
      else wall?.close();
    }
    setTimeout(() => this.#poll(), kSnapshotEvery);
  }
}
