// SPDX-License-Identifier: MIT
// The tiles' live pictures: a WebSocket (docs/streams.md) that connects again by itself, and the worker that decodes.
// While a packet of a stream is being decoded only the newest of those that come is kept: every packet of `huffyuv` is
// whole by itself.

import { Backoff } from './backoff.js';

const kCodec = 'huffyuv';
const kFrameBytes = 20;  // before the packet: stream:u32 sequence:u32 time:u64 flags:u32
const kFirstWait = 500, kMostWait = 15000;  // ms

const bytesOfBase64 = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0));

export class WallStream {
  #url; #on; #socket; #backoff = new Backoff(kFirstWait, kMostWait);
  #watch = [];
  #worker;
  #tiles = new Map();    // by stream: the tile's name, as walld said last
  #busy = new Map();     // by stream: the frame that is being decoded
  #waiting = new Map();  // by stream: the newest frame after that

  /** `on`: frame(tile, bitmap, taken), ended(tile, why), state(live), problem(text). `taken`: ms since 1970. */
  constructor(url, on) {
    this.#url = url;
    this.#on = on;
    this.#worker = new Worker(new URL('decode_worker.js', import.meta.url), { type: 'module' });
    this.#worker.onmessage = ({ data }) => this.#decoded(data);
    this.#connect();
  }

  /** [{tile, width, height, fps}] instead of what was watched before. */
  watch(list) {
    this.#watch = list.map(entry => ({ ...entry, codec: kCodec }));
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
      this.#tiles.clear();
      this.#waiting.clear();
      this.#on.state(false);
      setTimeout(() => this.#connect(), this.#backoff.next());
    };
  }

  #told(text) {
    const message = JSON.parse(text);
    this.#backoff.reset();
    if (message.error !== undefined) this.#on.problem(message.error);
    else if (message.ended !== undefined) this.#on.ended(this.#tiles.get(message.stream), message.ended);
    else if (message.tile !== undefined) this.#setFormat(message);
  }

  #setFormat({ stream, tile, codec, width, height, header }) {
    if (codec !== kCodec) return this.#on.problem(`tile ${tile} comes as ${codec}, which this page does not know`);
    this.#tiles.set(stream, tile);
    this.#waiting.delete(stream);
    this.#worker.postMessage({ stream, header: bytesOfBase64(header), width, height });
  }

  #received(message) {
    if (message.byteLength < kFrameBytes) return;
    const view = new DataView(message), stream = view.getUint32(0, true);
    if (!this.#tiles.has(stream)) return;
    const frame = { stream, tile: this.#tiles.get(stream), taken: Number(view.getBigUint64(8, true)) / 1000, message };
    if (this.#busy.has(stream)) this.#waiting.set(stream, frame);
    else this.#decode(frame);
  }

  #decode(frame) {
    this.#busy.set(frame.stream, frame);
    this.#worker.postMessage({ stream: frame.stream, packet: new Uint8Array(frame.message, kFrameBytes) }, [frame.message]);
  }

  #decoded({ stream, bitmap, error }) {
    const { tile, taken } = this.#busy.get(stream);
    this.#busy.delete(stream);
    if (bitmap) this.#on.frame(tile, bitmap, taken);
    else this.#on.problem(`tile ${tile}: ${error}`);
    const next = this.#waiting.get(stream);
    this.#waiting.delete(stream);
    if (next) this.#decode(next);
  }
}
