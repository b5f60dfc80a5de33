// SPDX-License-Identifier: MIT
// The two dialogs: a question before a window is closed, and a tile's lossless picture at full size.

import { snapshotUrl } from './api.js';
import { get } from './dom.js';

/** True if the answer is yes. */
export function ask(question) {
  const dialog = get('confirm');
  get('confirm-text').textContent = question;
  dialog.returnValue = '';
  get('confirm-yes').onclick = () => dialog.close('yes');
  get('confirm-no').onclick = () => dialog.close();
  dialog.showModal();
  return new Promise(resolve => dialog.addEventListener('close', () => resolve(dialog.returnValue === 'yes'),
      { once: true }));
}

export function showTilePicture(name) {
  const dialog = get('tile-picture'), image = get('tile-image');
  const load = () => { image.src = `${snapshotUrl(name)}&at=${Date.now()}`; };
  get('tile-name').textContent = `Tile ${name}`;
  image.alt = `What tile ${name} shows, pixel by pixel`;
  Object.assign(get('tile-download'), { href: snapshotUrl(name), download: `tile-${name}.png` });
  get('tile-again').onclick = load;
  get('tile-close').onclick = () => dialog.close();
  dialog.addEventListener('close', () => image.removeAttribute('src'), { once: true });
  load();
  dialog.showModal();
}
