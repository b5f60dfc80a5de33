// SPDX-License-Identifier: MIT
// The room from above: the person in the middle, and around them the screens of tiles that look elsewhere
// (docs/walls.md, "Views"). Every screen is drawn as far away as the others: a view tells directions and no distances.

import { get } from './dom.js';

const kSvg = 'http://www.w3.org/2000/svg';
const kMargin = 0.25;     // around the screens, of their distance
const kFarthest = 2.5;    // from the person: what is seen very aslant is cut
const kDegree = Math.PI / 180;

const corner = ([rx, ry, rz, ux, uy, uz, ax, ay, az], along, upwards) =>
    [ax + along * rx + upwards * ux, ay + along * ry + upwards * uy, az + along * rz + upwards * uz];
/** On the floor: to the right, and towards the viewer of the plan, so that ahead is up. */
const fromAbove = ([right, , ahead]) => {
  const far = Math.hypot(right, ahead), by = far > kFarthest ? kFarthest / far : 1;
  return [right * by, -ahead * by];
};

/**
 * Of each tile with a view: {name, state, corners, middle, text}, corners and middle being [x, y] of the plan with the
 * person at [0, 0]. `tiles`: [{name, state, view}], `view` as the status has it.
 */
export function screensOf(tiles) {
  return tiles.filter(({ view }) => view).map(({ name, state, view }) => {
    const [left, right, bottom, top] = view.slice(9), [ax, ay, az] = view.slice(6, 9);
    const corners = [[left, bottom], [right, bottom], [right, top], [left, top]]
        .map(([along, upwards]) => fromAbove(corner(view, along, upwards)));
    const middle = fromAbove(corner(view, (left + right) / 2, (bottom + top) / 2));
    const aside = Math.round(Math.atan2(ax, az) / kDegree);
    const up = Math.round(Math.atan2(ay, Math.hypot(ax, az)) / kDegree);
    const words = [aside && `${Math.abs(aside)}° to the ${aside > 0 ? 'right' : 'left'}`,
                   up && `${Math.abs(up)}° ${up > 0 ? 'up' : 'down'}`].filter(Boolean);
    return { name, state, corners, middle, text: `${name} looks ${words.join(', ') || 'ahead'}` };
  });
}

const points = list => list.map(([x, y]) => `${x.toFixed(3)},${y.toFixed(3)}`).join(' ');

function draw(tag, attributes, text) {
  const element = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

let shown = '';  // what is drawn

/** Draws it anew where something has changed; hidden if no tile looks elsewhere. */
export function showRoom(tiles, onTile) {
  const screens = screensOf(tiles), plan = JSON.stringify(screens);
  if (plan === shown) return;
  shown = plan;
  get('room-section').hidden = screens.length === 0;
  const reach = (1 + kMargin) * Math.max(1, ...screens.flatMap(({ corners }) => corners.flat().map(Math.abs)));
  const room = get('room');
  room.setAttribute('viewBox', [-reach, -reach, 2 * reach, 2 * reach].join(' '));
  room.setAttribute('aria-label', `The room from above: ${screens.map(({ text }) => text).join('; ')}`);
  room.replaceChildren(draw('circle', { cx: 0, cy: 0, r: 0.06, class: 'person' }), ...screens.map(screen => {
    const { name, state, corners, middle, text } = screen, tile = draw('g', { class: 'screen', 'data-state': state });
    tile.append(draw('title', {}, text),
        draw('polygon', { points: points([[0, 0], corners[0], corners[1]]), class: 'sight' }),
        draw('polygon', { points: points(corners), class: 'surface' }),
        draw('text', { x: middle[0] * 0.78, y: middle[1] * 0.78 }, name));
    tile.onclick = () => onTile(name);
    return tile;
  }));
}
