// SPDX-License-Identifier: MIT
// What lies over the wall's picture: tiles with their state, and windows that are selected, moved and resized with
// mouse, touch and keyboard. Each is an element of the document, so that screen readers and the Tab key find it.

import { get, keyed, make, setText } from './dom.js';
import { moved, placeText, resized } from './geometry.js';

const kStep = 10, kFineStep = 1;  // canvas pixels an arrow key moves
const kDragBegins = 3;            // CSS pixels: less is a click
const kArrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class WallView {
  #on; #wall;
  #windows = new Map();  // by id, as update() said

  /**
   * `on`: select(id or undefined), place(id, rect), key(name, id), openTile(name), openTileAt([x, y]),
   * refused(window).
   */
  constructor(on) {
    this.#on = on;
    get('picture').addEventListener('click', event => this.#clickPicture(event));
  }

  /** `wall`: {width, height}; `tiles`: [{name, rect, state}]; `windows`: [{id, rect, z, label, mayChange, ...}]. */
  update(wall, tiles, windows, selected) {
    this.#wall = wall;
    this.#windows = new Map(windows.map(window => [window.id, window]));
    keyed(get('tiles'), tiles, tile => tile.name, tile => this.#makeTile(tile),
        (element, tile) => this.#updateTile(element, tile));
    keyed(get('windows'), windows, window => window.id, window => this.#makeWindow(window),
        (element, window) => this.#updateWindow(element, window, window.id === selected));
  }

  #putAt(element, [x, y, width, height]) {
    const percent = (part, whole) => `${100 * part / whole}%`;
    Object.assign(element.style, {
      left: percent(x, this.#wall.width), top: percent(y, this.#wall.height),
      width: percent(width, this.#wall.width), height: percent(height, this.#wall.height) });
  }

  // ---- tiles ----

  #makeTile({ name }) {
    return make('div', { className: 'tile' },
        make('button', { type: 'button', onclick: () => this.#on.openTile(name) }));
  }
  #updateTile(element, { name, rect, state }) {
    this.#putAt(element, rect);
    element.dataset.state = state;
    const button = element.firstChild;
    setText(button, state === 'up' ? name : `${name}: ${state}`);
    button.title = `Tile ${name}, ${state}: its picture at full size`;
    button.setAttribute('aria-label', button.title);
  }

  /** Nothing lies there: the selection is let go, and a tile shows its picture. */
  #clickPicture({ offsetX, offsetY, target }) {
    const x = offsetX / target.clientWidth, y = offsetY / target.clientHeight;
    this.#on.select(undefined);
    this.#on.openTileAt([x * this.#wall.width, y * this.#wall.height]);
  }

  // ---- windows ----

  #makeWindow({ id }) {
    const handle = make('span', { className: 'handle' });
    handle.setAttribute('aria-hidden', 'true');
    const element = make('button', { type: 'button', className: 'window' }, make('span', { className: 'title' }),
        handle);
    element.setAttribute('aria-describedby', 'help');
    element.setAttribute('aria-keyshortcuts', 'ArrowUp ArrowDown ArrowLeft ArrowRight PageUp PageDown Delete Escape');
    element.addEventListener('focus', () => this.#on.select(id));
    element.addEventListener('click', () => this.#on.select(id));
    element.addEventListener('keydown', event => this.#press(event, id));
    element.addEventListener('pointerdown', event => this.#grab(event, id, event.target === handle ? resized : moved));
    return element;
  }
  #updateWindow(element, window, selected) {
    this.#putAt(element, window.rect);
    element.style.zIndex = window.z;
    element.classList.toggle('movable', window.mayChange);
    element.setAttribute('aria-pressed', selected);
    element.setAttribute('aria-label',
        `Window ${window.label}, ${placeText(window.rect)}${window.mayChange ? '' : ', of somebody else'}`);
    setText(element.firstChild, window.label);
  }

  #press(event, id) {
    const window = this.#windows.get(id), arrow = kArrows[event.key];
    if (event.altKey || event.metaKey || !window) return;
    if (arrow) {
      event.preventDefault();
      if (!window.mayChange) return this.#on.refused(window);
      const step = event.ctrlKey ? kFineStep : kStep, change = event.shiftKey ? resized : moved;
      this.#place(event.currentTarget, window, change(window.rect, arrow[0] * step, arrow[1] * step, this.#wall));
    } else if (['PageUp', 'PageDown', 'Delete', 'Escape'].includes(event.key)) {
      event.preventDefault();
      this.#on.key(event.key, id);
    }
  }

  /** Seen at once; walld follows. */
  #place(element, window, rect) {
    window.rect = rect;
    this.#putAt(element, rect);
    this.#on.place(window.id, rect);
  }

  /** Follows one pointer until it is let go; Escape puts the window back. */
  #grab(event, id, change) {
    const element = event.currentTarget, from = this.#windows.get(id);
    this.#on.select(id);
    if (event.button !== 0 || !event.isPrimary || !from.mayChange) return;
    const begin = from.rect, scale = this.#wall.width / get('wall').clientWidth;
    const { clientX, clientY, pointerId } = event, until = new AbortController(), listen = { signal: until.signal };
    let dragging = false;
    element.setPointerCapture(pointerId);
    const put = rect => this.#windows.has(id) && this.#place(element, this.#windows.get(id), rect);
    element.addEventListener('pointermove', now => {
      const dx = now.clientX - clientX, dy = now.clientY - clientY;
      dragging ||= Math.hypot(dx, dy) >= kDragBegins;
      if (dragging) put(change(begin, dx * scale, dy * scale, this.#wall));
    }, listen);
    const end = () => until.abort();
    element.addEventListener('pointerup', end, listen);
    element.addEventListener('lostpointercapture', end, listen);
    element.addEventListener('keydown', ({ key }) => {
      if (key !== 'Escape') return;
      put(begin);
      end();
    }, listen);
  }
}
