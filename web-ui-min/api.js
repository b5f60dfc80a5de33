// SPDX-License-Identifier: MIT
// walld's REST interface (docs/http-api.md) as functions that give JSON or throw.

const kBase = 'api/v1/';

async function ask(method, path, body) {
  const options = { method, cache: 'no-store' };
  if (method === 'PUT' || method === 'POST') {
    options.headers = { 'Content-Type': 'application/json' };
    options.body = JSON.stringify(body ?? {});
  }
  const answer = await fetch(kBase + path, options);
  if (answer.ok) return answer.json();
  const why = await answer.json().catch(() => null);
  throw Object.assign(new Error(why?.error?.message ?? `walld answers ${answer.status}`), { status: answer.status });
}

const session = id => `sessions/${encodeURIComponent(id)}`;
const layout = name => `layouts/${encodeURIComponent(name)}`;

export const getStatus = () => ask('GET', 'status');
export const getWhoami = () => ask('GET', 'whoami');
/** walld sets a cookie, which no script sees; from then on it knows this browser as the token's. */
export const login = token => ask('POST', 'login', { token });
export const logout = () => ask('POST', 'logout');
/** Canvas pixels: [x, y, width, height]. */
export const place = (id, rect) => ask('PUT', `${session(id)}/placement`, { rect });
export const raise = id => ask('POST', `${session(id)}/raise`);
export const lower = id => ask('POST', `${session(id)}/lower`);
/** `wanted`: {on, separation, distance} in percent and the program's units. */
export const setStereo = (id, wanted) => ask('POST', `${session(id)}/stereo`, wanted);
/** Answers once it is closed, which a program may take its time for. */
export const close = id => ask('DELETE', session(id));

export const getLayouts = () => ask('GET', 'layouts');
export const saveLayout = name => ask('PUT', layout(name));
export const loadLayout = name => ask('POST', `${layout(name)}/load`);
export const deleteLayout = name => ask('DELETE', layout(name));

/** The address of the picture of a tile, or of the wall. */
export const snapshotUrl = tile =>
    `${kBase}snapshot.png${tile === undefined ? '' : `?tile=${encodeURIComponent(tile)}`}`;

/** The picture of the wall now, as ImageBitmap. */
export async function getSnapshot() {
  const answer = await fetch(snapshotUrl(), { cache: 'no-store' });
  if (!answer.ok) throw new Error(`walld answers ${answer.status}`);
  return createImageBitmap(await answer.blob());
}

/** The address of the streams. */
export function streamUrl() {
  const url = new URL(`${kBase}stream`, document.baseURI);
  url.protocol = url.protocol.replace('http', 'ws');
  return url.href;
}
