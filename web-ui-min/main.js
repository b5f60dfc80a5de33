// SPDX-License-Identifier: MIT
// The status page: asks walld for the wall's status once a second, joins it with rates and roles, and gives it to the
// parts that show it. docs/http-api.md has the interface, docs/streams.md that of the live picture.

import * as api from './api.js';
import { Backoff } from './backoff.js';
import { ask, showTilePicture, signIn } from './dialogs.js';
import { get, setText } from './dom.js';
import { contains, same } from './geometry.js';
import { Layouts } from './layouts.js';
import { LivePicture } from './live_picture.js';
import { mayChange, mayOperate, Rates, tileSkew, tileState, windowsOf } from './model.js';
import { Mover } from './mover.js';
import { showRoom } from './room.js';
import { StereoControl, stereoText } from './stereo.js';
import { showTables } from './tables.js';
import { WallPicture } from './wall_picture.js';
import { WallView } from './wall_view.js';

const kStatusEvery = 1000;            // ms
const kProblemFor = 8000;             // ms that a message of failure stays
const kMostHeight = 0.72;             // of the window's height, for the wall
const kSignIn = 401;                  // of HTTP: walld does not know who asks
const kFirstWait = 1000, kMostWait = 10000;  // ms until walld is asked again when it does not answer

let status, who, selected;
let windows = [], tiles = [];
let answers = true, live = false, problemTimer;
const rates = new Rates();
const backoff = new Backoff(kFirstWait, kMostWait);
const picture = new WallPicture(get('picture'));
const mover = new Mover(refresh, showProblem);
const layouts = new Layouts(run);
const view = new WallView({
  select,
  place: (id, rect) => mover.place(id, rect),
  key: (name, id) => ({ PageUp: raise, PageDown: lower, Delete: close, Escape: letGo })[name](id),
  openTile: showTilePicture,
  openTileAt: point => {
    const tile = tiles.find(({ rect }) => contains(rect, point));
    if (tile) showTilePicture(tile.name);
  },
  refused: window =>
      showProblem(new Error(`You may not change ${window.label}: your role is ${who?.role ?? 'not known'}`)),
});
const stereo = new StereoControl(
    ({ label, session: { id } }, wanted) => run(() => api.setStereo(id, wanted), () => {
      const said = stereoText({ stereo: wanted.on ? wanted : null });
      return `${label}: ${said ?? 'both eyes see the same'}`;
    }), showProblem);
let livePicture;  // once walld has said who watches
function watchLive() {
  livePicture ??= new LivePicture(picture, isLive => {
    live = isLive;
    showConnection();
  }, text => showProblem(new Error(text)));
}

// ---- what is said ----

function announce(text) { get('announce').textContent = text; }

function showProblem({ message }) {
  setText(get('problem'), message);
  get('problem').hidden = false;
  clearTimeout(problemTimer);
  problemTimer = setTimeout(() => { get('problem').hidden = true; }, kProblemFor);
}

async function run(action, done) {
  try {
    announce(done(await action()));
    await refresh();
  } catch (error) {
    showProblem(error);
  }
}

function showConnection(wait) {
  const [state, text] = !answers ? ['lost', `walld does not answer; next try in ${Math.round(wait / 1000)} s`]
    : live ? ['live', 'live'] : ['pictures', 'no live stream: a new picture every few seconds, connecting again'];
  get('connection').dataset.state = state;
  setText(get('connection'), text);
}

// ---- the selected window ----

function select(id) {
  selected = id;
  if (status) show();
}
function letGo() {
  document.activeElement?.blur();
  select(undefined);
}
const labelOf = id => windows.find(window => window.id === id).label;
const raise = id => run(() => api.raise(id), () => `${labelOf(id)} is before all others`);
const lower = id => run(() => api.lower(id), () => `${labelOf(id)} is behind all others`);
async function close(id) {
  const label = labelOf(id);
  if (!windows.find(window => window.id === id).mayChange) return showProblem(new Error(`You may not close ${label}`));
  if (await ask(`Close ${label}? Its program is asked to end.`)) run(() => api.close(id), () => `${label} is closed`);
}

function showTools() {
  const window = windows.find(({ id }) => id === selected);
  setText(get('selected'), window ? `${window.id} ${window.label}` : 'No window is selected');
  for (const id of ['raise', 'lower', 'close']) get(id).disabled = !window?.mayChange;
  stereo.show(status.tiles, window);
}

// ---- the wall's status ----

/** Says what has changed since `before`, for those who do not see it. */
function announceChanges(before, now) {
  const wasUp = new Map(before.tiles.map(tile => [tile.name, tile.up]));
  const sessions = list => new Map(list.map(session => [session.id, session.name || session.program]));
  const old = sessions(before.sessions), current = sessions(now.sessions);
  const said = [
    ...now.tiles.filter(tile => wasUp.get(tile.name) !== tile.up)
        .map(tile => `Tile ${tile.name} is ${tile.up ? 'back' : 'away'}.`),
    ...[...current].filter(([id]) => !old.has(id)).map(([, name]) => `${name} has come.`),
    ...[...old].filter(([id]) => !current.has(id)).map(([, name]) => `${name} has ended.`),
  ];
  if (said.length) announce(said.join(' '));
}

async function refresh() {
  const next = await api.getStatus();
  if (status) announceChanges(status, next);
  status = next;
  rates.add(status, performance.now());
  show();
}

function show() {
  windows = windowsOf(status).map(window => ({ ...window, rect: mover.rectOf(window),
      mayChange: mayChange(who, window.session) }));
  if (!windows.some(({ id }) => id === selected)) selected = undefined;
  tiles = status.tiles.map(tile => ({
    ...tile, state: tileState(tile, windows, rates), skew: tileSkew(tile, windows),
    age: tile.up && livePicture.taken.has(tile.name)
        ? Math.max(0, Date.now() - livePicture.taken.get(tile.name)) : undefined }));
  setText(get('name'), status.wall.name);
  document.title = `${status.wall.name}: WallGL`;
  // Where two eyes see the wall, this is the left one's.
  const seen = tiles.filter(({ eye }) => eye !== 'right');
  picture.setTiles(status.wall, seen.map(({ name, rect, state }) => ({ name, rect, away: state === 'away' })));
  fitWall();
  view.update(status.wall, seen, windows, selected);
  showRoom(tiles, showTilePicture);
  showTables({ status, windows, tiles, rates }, { onWindow: select, onTile: showTilePicture });
  showTools();
  livePicture.refresh();
}

function fitWall() {
  const { width, height } = status.wall, wall = get('wall');
  const fit = Math.min(wall.parentElement.clientWidth, kMostHeight * innerHeight * width / height);
  const size = [`${fit}px`, `${fit * height / width}px`];
  if (!same(size, [wall.style.width, wall.style.height])) [wall.style.width, wall.style.height] = size;
  picture.setWidth(fit);
}

async function becomeKnown() {
  who = await api.getWhoami();
  setText(get('who'), `${who.name || who.kind}, ${who.role}`);
  get('sign-out').hidden = who.kind !== 'token';
  await layouts.refresh(mayOperate(who));
}

async function poll() {
  let wait = kStatusEvery;
  try {
    if (!document.hidden || !status) {
      if (!who || !answers) await becomeKnown();
      watchLive();
      await refresh();
      answers = true;
      backoff.reset();
    }
  } catch (error) {
    answers = false;
    wait = backoff.next();
    if (error.status === kSignIn) {
      await signIn(api.login);
      wait = 0;
    }
  }
  showConnection(wait);
  setTimeout(poll, wait);
}

get('sign-out').onclick = async () => {
  await api.logout().catch(showProblem);
  location.reload();
};
get('raise').onclick = () => raise(selected);
get('lower').onclick = () => lower(selected);
get('close').onclick = () => close(selected);
get('pause').onclick = ({ target }) => {
  const pause = target.getAttribute('aria-pressed') !== 'true';
  target.setAttribute('aria-pressed', pause);
  if (livePicture) livePicture.paused = pause;
};
addEventListener('resize', () => {
  if (!status) return;
  fitWall();
  livePicture?.refresh();
});
dispatchEvent(new Event('wallgl-started'));
poll();
