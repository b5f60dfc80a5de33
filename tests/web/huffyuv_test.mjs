// SPDX-License-Identifier: MIT
// The page's HuffYUV decoder against frames that FFmpeg has written, bit for bit, and against streams that cannot be.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { HuffyuvDecoder, HuffyuvError } from '../../web-ui-min/huffyuv.js';

const kBitmapInfoBytes = 40;
const folder = mkdtempSync(join(tmpdir(), 'wallgl-huffyuv-'));
process.on('exit', () => rmSync(folder, { recursive: true, force: true }));

function ffmpeg(...options) {
  execFileSync('ffmpeg', ['-hide_banner', '-loglevel', 'error', '-y', ...options.map(String)],
      { stdio: ['ignore', 'inherit', 'inherit'] });
}

/** Extradata and packets of a small AVI file. */
function readAvi(file) {
  const bytes = readFileSync(file), found = { packets: [] };
  const walk = (from, to) => {
    for (let at = from; at + 8 <= to;) {
      const id = bytes.toString('latin1', at, at + 4), size = bytes.readUInt32LE(at + 4), body = at + 8;
      if (id === 'RIFF' || id === 'LIST') walk(body + 4, body + size);
      if (id === 'strf') found.header = new Uint8Array(bytes.subarray(body + kBitmapInfoBytes, body + size));
      if (id === '00dc') found.packets.push(new Uint8Array(bytes.subarray(body, body + size)));
      at = body + size + size % 2;
    }
  };
  walk(0, bytes.length);
  return found;
}

/** A moving picture with flat, smooth and noisy parts as FFmpeg presses it, and what FFmpeg makes of that again. */
function fromFfmpeg({ size, pred, pixels, flags = [] }) {
  const avi = join(folder, `${size}-${pred}-${pixels}${flags.join('')}.avi`);
  const noise = pixels === 'bgra' ? 'noise=c0s=30:c3s=20:allf=t' : 'noise=c0s=12:allf=t';
  ffmpeg('-f', 'lavfi', '-i', `testsrc=size=${size}:rate=5`, '-frames:v', 3, '-vf',
      `format=${pixels === 'bgra' ? 'gbrap' : 'gbrp'},${noise},format=${pixels}`,
    '-c:v', 'huffyuv', '-pred', pred, '-pix_fmt', pixels, ...flags, avi);
  ffmpeg('-i', avi, '-f', 'rawvideo', '-pix_fmt', 'rgba', `${avi}.raw`);
  return { ...readAvi(avi), raw: readFileSync(`${avi}.raw`) };
}

function assertSamePictures({ header, packets, raw }, width, height) {
  const decoder = new HuffyuvDecoder(header, width, height);
  assert.equal(packets.length, 3);
  packets.forEach((packet, i) => {
    const picture = decoder.decode(packet);
    const wanted = raw.subarray(i * picture.length, (i + 1) * picture.length);
    assert.ok(Buffer.from(picture.buffer).equals(wanted),
        `frame ${i} differs at byte ${picture.findIndex((byte, at) => byte !== wanted[at])}`);
  });
}

for (const pixels of ['rgb24', 'bgra']) {
  for (const pred of ['left', 'plane']) {
    for (const size of ['320x240', '57x33', '16x1', '1x16']) {
      test(`FFmpeg's ${pixels}, ${pred}, ${size}`, () =>
          assertSamePictures(fromFfmpeg({ size, pred, pixels }), ...size.split('x').map(Number)));
    }
    test(`FFmpeg's ${pixels}, ${pred}, interlaced`, () =>
        assertSamePictures(fromFfmpeg({ size: '64x48', pred, pixels, flags: ['-flags', '+ilme'] }), 64, 48));
  }
}

// ---- streams made here: what FFmpeg does not write, and what must be refused ----

const flat = [8, 255, 1 << 5 | 8];  // 256 codes of 8 bits: a run of 255 and one of 1
const headerOf = ({ method = 0, bits = 24, interlacing = 0x20, tables = [flat, flat, flat] } = {}) =>
    Uint8Array.from([method, bits, interlacing, 0, ...tables.flat()]);

/** The bytes of the bit string, highest bit of a 32-bit little-endian word first. */
function packetOf(bytes) {
  const padded = [...bytes, ...new Array((4 - bytes.length % 4) % 4).fill(0)];
  return Uint8Array.from(padded, (_, i) => padded[i - i % 4 + 3 - i % 4]);
}

test('without decorrelation: blue, green, red as they are', () => {
  // 8-bit codes of an even table are the symbols themselves.
  const picture = new HuffyuvDecoder(headerOf(), 2, 1).decode(packetOf([10, 20, 30, 0, 1, 2, 3]));
  assert.deepEqual([...picture], [10, 20, 30, 255, 13, 22, 31, 255]);
});

test('with decorrelation: green, then blue and red less green', () => {
  const picture = new HuffyuvDecoder(headerOf({ method: 64 }), 2, 1).decode(packetOf([10, 20, 30, 0, 2, 1, 3]));
  assert.deepEqual([...picture], [10, 20, 30, 255, 15, 22, 33, 255]);
});

test('codes longer than the tables index', () => {
  // Lengths 1, 2, ... 30, 31, 31: symbol 30 is 31 zeros, symbol 31 is thirty zeros and a one.
  const long = [...Array.from({ length: 30 }, (_, i) => 1 << 5 | (i + 1)), 2 << 5 | 31, 0, 224];
  const zeros = n => '0'.repeat(n);
  const bits = `${zeros(32)}${zeros(30)}1${zeros(31)}1`.padEnd(128, '0');
  const bytes = bits.match(/.{8}/g).map(byte => parseInt(byte, 2));
  const picture = new HuffyuvDecoder(headerOf({ tables: [long, long, long] }), 2, 1).decode(packetOf(bytes));
  assert.deepEqual([...picture.subarray(4)], [0, 30, 31, 255]);
});

test('headers that cannot be are refused', () => {
  const bad = {
    'no bytes': Uint8Array.of(),
    'no tables': headerOf({ tables: [] }),
    'a table cut short': headerOf().subarray(0, -1),
    'median of RGB': headerOf({ method: 2 }),
    'YUY2': headerOf({ bits: 16 }),
    'tables per frame': headerOf({ interlacing: 0x60 }),
    'over-full codes': headerOf({ tables: [[7, 255, 1 << 5 | 7], flat, flat] }),
    'half a pair': headerOf({ tables: [[8, 255, 1 << 5], flat, flat] }),
    'a run of nothing': headerOf({ tables: [[8, 0], flat, flat] }),
    'a run beyond the table': headerOf({ tables: [[8, 255, 2 << 5 | 8], flat, flat] }),
  };
  for (const [what, header] of Object.entries(bad)) {
    assert.throws(() => new HuffyuvDecoder(header, 8, 8), HuffyuvError, what);
  }
});

test('sizes that cannot be are refused', () => {
  for (const [width, height] of [[0, 1], [1, -1], [1.5, 1], [NaN, 1], [40000, 1], [30000, 30000], [undefined, 1]]) {
    assert.throws(() => new HuffyuvDecoder(headerOf(), width, height), HuffyuvError, `${width}x${height}`);
  }
});

test('every proper prefix of a packet is refused', () => {
  const { header, packets: [packet] } = fromFfmpeg({ size: '57x33', pred: 'plane', pixels: 'rgb24' });
  const decoder = new HuffyuvDecoder(header, 57, 33);
  for (let length = 0; length < packet.length; ++length) {
    assert.throws(() => decoder.decode(packet.subarray(0, length)), HuffyuvError, `${length} bytes`);
  }
  decoder.decode(packet);
});

test('a packet far too large is refused', () => {
  assert.throws(() => new HuffyuvDecoder(headerOf(), 1, 1).decode(new Uint8Array(1 << 20)), HuffyuvError);
});

test('damaged packets and headers give a picture or an error, soon', () => {
  const { header, packets: [packet] } = fromFfmpeg({ size: '57x33', pred: 'left', pixels: 'bgra' });
  let seed = 1;
  const random = below => (seed = Math.imul(seed, 1103515245) + 12345 >>> 0) % below;
  const damaged = bytes => bytes.map(byte => random(50) === 0 ? byte ^ 1 << random(8) : byte);
  for (let round = 0; round < 300; ++round) {
    try {
      assert.equal(new HuffyuvDecoder(round % 2 ? damaged(header) : header, 57, 33).decode(damaged(packet)).length,
          57 * 33 * 4);
    } catch (error) {
      assert.ok(error instanceof HuffyuvError, error.stack);
    }
  }
});
