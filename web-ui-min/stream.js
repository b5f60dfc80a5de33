// SPDX-License-Identifier: MIT
// The wall's live picture, tile by tile: a WebSocket (docs/streams.md) that connects again by itself, and the worker
// that decodes. While a packet of a part is being decoded only the newest of those that come is kept: every packet of
// `huffyuv` is whole by itself.

import { Backoff } from './backoff.js';

const kCodec = 'huffyuv';
const kFrameBytes = 24;  // before the packet: stream:u32 part:u32 time:u64 sequence:u32 flags:u32
const kFirstWait = 500, kMostWait = 15000;  // ms

const bytesOfBase64 = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0));

export class WallStream {
  #url; #on; #socket; #backoff = new Backoff(kFirstWait, kMostWait);
  #watch = [];
  #worker;
  #parts = [];           // as walld told them last: {tile, rect, known}; known: the decoder has its header
  #busy = new Map();     // by part: the frame that is being decoded
  #waiting = new Map();  // by part: the newest frame after that

  /** `on`: frame(tile, bitmap, taken), ended(tile, why), state(live), problem(text). `taken`: ms since 1970. */
  constructor(url, on) {
    this.#url = url;
    this.#on = on;
    this.#worker = new Worker(new URL('decode_worker.js', import.meta.url), { type: 'module' });
    this.#worker.onmessage = ({ data }) => this.#decoded(data);
    this.#connect();
  }

  /** {wall, width, height, fps} instead of what was watched before; undefined: nothing. */
  watch(entry) {
    this.#watch = entry ? [{ ...entry, codec: kCodec }] : [];
    this.#sendWatch();
  }

  #sendWatch() {
    if (this.#socket.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify({ watch: this.#watch }));
  }

  #connect() {
    const socket = this.#socket = new WebSocket(this.#url);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.#on.state(true);
      this.#sendWatch();
    };
    socket.onmessage = ({ data }) => typeof data === 'string' ? this.#told(data) : this.#received(data);
    socket.onclose = () => {
      this.#parts = [];
      this.#waiting.clear();
      this.#on.state(false);
      setTimeout(() => this.#connect(), this.#backoff.next());
    };
  }

  #told(text) {
    const message = JSON.parse(text);
    this.#backoff.reset();
    if (message.error !== undefined) this.#on.problem(message.error);
    else if (message.parts !== undefined) this.#setParts(message);
    else if (message.header !== undefined) this.#setHeader(message);
    else if (message.ended !== undefined) this.#end(message);
  }

  #setParts({ codec, parts }) {
    if (codec !== kCodec) this.#on.problem(`the wall comes as ${codec}, which this page does not know`);
    this.#parts = codec === kCodec ? parts : [];
    this.#waiting.clear();
  }

  #setHeader({ part, header }) {
    if (!this.#parts[part]) return;
    const { rect: [, , width, height] } = this.#parts[part];
    this.#parts[part].known = true;
    this.#waiting.delete(part);
    this.#worker.postMessage({ part, header: bytesOfBase64(header), width, height });
  }

  #end({ part, ended }) {
    if (!this.#parts[part]) return;
    this.#parts[part].known = false;
    this.#on.ended(this.#parts[part].tile, ended);
  }

  #received(message) {
    if (message.byteLength < kFrameBytes) return;
    const view = new DataView(message), part = view.getUint32(4, true);
    if (!this.#parts[part]?.known) return;
    const frame = { part, tile: this.#parts[part].tile, taken: Number(view.getBigUint64(8, true)) / 1000, message };
    if (this.#busy.has(part)) this.#waiting.set(part, frame);
    else this.#decode(frame);
  }

  #decode(frame) {
    this.#busy.set(frame.part, frame);
    this.#worker.postMessage({ part: frame.part, packet: new Uint8Array(frame.message, kFrameBytes) }, [frame.message]);
  }

  #decoded({ part, bitmap, error }) {
    const { tile, taken } = this.#busy.get(part);
    this.#busy.delete(part);
    if (bitmap) this.#on.frame(tile, bitmap, taken);
    else this.#on.problem(`tile ${tile}: ${error}`);
    const next = this.#waiting.get(part);
    this.#waiting.delete(part);
    if (next) this.#decode(next);
  }
}
