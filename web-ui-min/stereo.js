// SPDX-License-Identifier: MIT
// How the selected window's program is shown to two eyes (docs/walls.md, "Stereo"): on or off, how far the eyes'
// pictures are apart, and what distance lies in the wall's plane. There only where tiles are for one eye.

import { get, setText } from './dom.js';

export const kUsualSeparation = 1.5;  // percent of the window's width, as walld has it
const kMostSeparation = 25;           // percent
const kFarthest = 1e9;                // the program's units

/** Whether a wall has tiles for one eye. */
export const hasEyes = tiles => tiles.some(({ eye }) => eye);

/** As `wallctl sessions` says it; undefined where both eyes see the same. */
export function stereoText({ stereo }) {
  if (!stereo) return undefined;
  const rounded = value => Number(value.toPrecision(3));
  return `stereo ${rounded(stereo.separation)} %${stereo.distance > 0 ? ` at ${rounded(stereo.distance)}` : ''}`;
}

/** The body of a request, out of what the fields say: an empty distance is measured. Throws what is wrong with them. */
export function wantedStereo(on, separationText, distanceText) {
  if (!on) return { on };
  const numberIn = (text, least, most, what) => {
    const number = Number(text);
    if (!(text.trim() && number >= least && number <= most)) throw new Error(`${what}: expected ${least} to ${most}`);
    return number;
  };
  const separation = numberIn(separationText, -kMostSeparation, kMostSeparation, 'Eyes apart');
  const distance = distanceText.trim() ? numberIn(distanceText, 0, kFarthest, 'Distance in the wall’s plane') : 0;
  return { on, separation, distance };
}

export class StereoControl {
  #set; #window; #told;

  /** `set(window, wanted)`: tells walld, or says what went wrong; `refuse(error)`: the fields make no sense. */
  constructor(set, refuse) {
    this.#set = set;
    const tell = on => {
      try {
        this.#set(this.#window, wantedStereo(on, get('stereo-separation').value, get('stereo-distance').value));
      } catch (error) {
        refuse(error);
      }
    };
    get('stereo-on').onclick = () => tell(!this.#window.session.stereo);
    for (const field of ['stereo-separation', 'stereo-distance'])
      get(field).onchange = () => this.#window?.session.stereo && tell(true);
  }

  /** `window`: the one that is selected, as main.js joins it; undefined: none. */
  show(tiles, window) {
    get('stereo').hidden = !hasEyes(tiles);
    const other = this.#window?.id !== window?.id;
    this.#window = window;
    const on = Boolean(window?.session.stereo), may = Boolean(window?.mayChange) && !window.session.group;
    get('stereo-on').setAttribute('aria-pressed', on);
    setText(get('stereo-on'), on ? 'Seen by two eyes' : 'Show to two eyes');
    for (const id of ['stereo-on', 'stereo-separation', 'stereo-distance']) get(id).disabled = !may;
    // Not while somebody types: only when walld says something new.
    const told = JSON.stringify(window?.session.stereo ?? null);
    if (!other && told === this.#told) return;
    this.#told = told;
    const { separation, distance } = window?.session.stereo ?? { separation: kUsualSeparation, distance: 0 };
    get('stereo-separation').value = Number(separation.toPrecision(3));
    get('stereo-distance').value = distance > 0 ? Number(distance.toPrecision(6)) : '';
  }
}
