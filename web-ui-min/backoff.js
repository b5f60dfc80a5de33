// SPDX-License-Identifier: MIT
// How long to wait before the next try: twice as long each time, a little at random so that a room full of pages does
// not come back at once.

export class Backoff {
  #first; #most; #next;
  constructor(first, most) {
    this.#first = this.#next = first;
    this.#most = most;
  }
  reset() { this.#next = this.#first; }
  /** ms */
  next() {
    const wait = this.#next * (0.8 + 0.4 * Math.random());
    this.#next = Math.min(2 * this.#next, this.#most);
    return wait;
  }
}
