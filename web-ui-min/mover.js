// SPDX-License-Identifier: MIT
// Windows on their way to a new place: shown there at once, sent to walld one request at a time, newest wins.

import * as api from './api.js';

const kMoveEvery = 100;  // ms between two requests for one window

export class Mover {
  #wanted = new Map();  // by window: the rectangle until walld's status has it
  #refresh; #failed;

  /** `refresh()`: a new status, awaited; `failed(error)`. */
  constructor(refresh, failed) {
    this.#refresh = refresh;
    this.#failed = failed;
  }

  rectOf(window) { return this.#wanted.get(window.id) ?? window.rect; }

  async place(id, rect) {
    const underWay = this.#wanted.has(id);
    this.#wanted.set(id, rect);
    if (underWay) return;
    try {
      for (let sent; sent !== this.#wanted.get(id);) {
        sent = this.#wanted.get(id);
        await api.place(id, sent);
        await new Promise(resolve => setTimeout(resolve, kMoveEvery));
        await this.#refresh();
      }
    } catch (error) {
      this.#failed(error);
    }
    this.#wanted.delete(id);
  }
}
