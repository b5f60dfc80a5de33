// SPDX-License-Identifier: MIT
// The dialogs: a question before a window is closed, a tile's lossless picture at full size, and signing in.

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

/** Asks for a token until `login` takes one. */
export function signIn(login) {
  const dialog = get('sign-in'), token = get('token'), problem = get('sign-in-problem');
  problem.hidden = true;
  get('sign-in-form').onsubmit = async event => {
    event.preventDefault();
    get('sign-in-go').disabled = true;
    try {
      await login(token.value.trim());
      dialog.close();
    } catch (error) {
      problem.textContent = error.message;
      problem.hidden = false;
      token.select();
    }
    get('sign-in-go').disabled = false;
  };
  dialog.oncancel = event => event.preventDefault();  // there is nothing to see without
  if (!dialog.open) dialog.showModal();
  return new Promise(resolve => dialog.addEventListener('close', () => {
    token.value = '';
    resolve();
  }, { once: true }));
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
