// SPDX-License-Identifier: MIT
// The canvas: the wall to scale, bezels included, each tile with its newest picture. Draws once a display frame at
// most, and only when something has changed.

import { scaledRect } from './geometry.js';

const kBezel = '#23262b', kNoPicture = '#08090b', kAway = '#6b1420', kAwayStripe = '#8c2230';
const kStripe = 12;  // pixels

export class WallPicture {
  #canvas; #context;
  #size = { width: 1, height: 1 };  // of the wall
  #tiles = [];
  #pictures = new Map();            // by tile: ImageBitmap
  #wall;                            // of the whole wall, for tiles without one of their own
  #due = false;

  constructor(canvas) {
    this.#canvas = canvas;
    this.#context = canvas.getContext('2d', { alpha: false });
  }

  /** Pixels. */
  get size() { return { width: this.#canvas.width, height: this.#canvas.height }; }

  /** `tiles`: [{name, rect, away}] */
  setTiles(size, tiles) {
    this.#size = size;
    this.#tiles = tiles;
    tiles.filter(tile => tile.away).forEach(tile => this.drop(tile.name));
    this.#draw();
  }
  /** In CSS pixels; the picture has those of the display. */
  setWidth(width) {
    const pixels = Math.max(1, Math.min(Math.round(width * devicePixelRatio), this.#size.width));
    const rows = Math.max(1, Math.round(pixels * this.#size.height / this.#size.width));
    if (this.#canvas.width === pixels && this.#canvas.height === rows) return;
    Object.assign(this.#canvas, { width: pixels, height: rows });
    this.#draw();
  }
  show(tile, bitmap) {
    this.#pictures.get(tile)?.close();
    this.#pictures.set(tile, bitmap);
    this.#draw();
  }
  drop(tile) {
    this.#pictures.get(tile)?.close();
    if (this.#pictures.delete(tile)) this.#draw();
  }
  /** Undefined: none. */
  showWall(bitmap) {
    this.#wall?.close();
    this.#wall = bitmap;
    this.#draw();
  }
  dropTiles() {
    for (const tile of [...this.#pictures.keys()]) this.drop(tile);
  }

  #draw() {
    if (this.#due) return;
    this.#due = true;
    requestAnimationFrame(() => {
      this.#due = false;
      this.#context.fillStyle = kBezel;
      this.#context.fillRect(0, 0, this.#canvas.width, this.#canvas.height);
      for (const tile of this.#tiles) this.#drawTile(tile, scaledRect(tile.rect, this.#size, this.size));
    });
  }
  #drawTile({ name, rect, away }, at) {
    const context = this.#context, own = this.#pictures.get(name);
    if (away) return this.#drawAway(at);
    if (own) return context.drawImage(own, ...at);
    if (this.#wall) return context.drawImage(this.#wall, ...rect, ...at);
    context.fillStyle = kNoPicture;
    context.fillRect(...at);
  }
  #drawAway([x, y, width, height]) {
    const context = this.#context;
    context.save();
    context.beginPath();
    context.rect(x, y, width, height);
    context.clip();
    context.fillStyle = kAway;
    context.fillRect(x, y, width, height);
    context.strokeStyle = kAwayStripe;
    context.lineWidth = kStripe / 3;
    context.beginPath();
    for (let at = -height; at < width; at += kStripe) {
      context.moveTo(x + at, y + height);
      context.lineTo(x + at + height, y);
    }
    context.stroke();
    context.restore();
  }
}
