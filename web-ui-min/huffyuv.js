// SPDX-License-Identifier: MIT
// Decoder of codec `huffyuv` (docs/codecs.md): RGB24 and RGB32 with and without decorrelation, left and gradient
// prediction, progressive and interlaced, tables per stream. Every packet is a key frame. Trusts nothing: what cannot
// be throws HuffyuvError. Pure; runs in the decode worker and under Node.

const kMaxExtent = 32768, kMaxPixels = 1 << 26;  // pixels
const kSymbols = 256, kMaxLength = 31;           // bits
const kFixedBytes = 4;                           // of the header: method, bits a pixel, interlacing, zero
const kDecorrelate = 64, kPerFrameTables = 0x40;
const kInterlaceMask = 0x30, kInterlaced = 0x10, kProgressive = 0x20;
const kInterlacedAbove = 288;                    // rows; where a stream does not say, taller ones are interlaced
const kLeft = 0, kGradient = 1;
const kIndexBits = 13;                           // of the tables that look up whole pixels and symbols
const kMostPixelWords = 4;                       // what a pixel can take: four codes of 31 bits
const kOpaque = 0xff000000 | 0;

export class HuffyuvError extends Error {}

function check(good, message) {
  if (!good) throw new HuffyuvError(`huffyuv: ${message}`);
}

// ---- the stream's header ----

/** Code lengths of one table, run by run from `at`; gives where the next table begins. */
function readLengths(header, at, lengths) {
  for (let symbol = 0; symbol < kSymbols;) {
    check(at < header.length, `a code table ends at symbol ${symbol}`);
    const head = header[at++];
    let run = head >> 5;
    if (run === 0) {
      check(at < header.length, `a code table ends at symbol ${symbol}`);
      run = header[at++];
    }
    check(run > 0 && run <= kSymbols - symbol, `a run of ${run} at symbol ${symbol} of a code table`);
    lengths.fill(head & 31, symbol, symbol + run);
    symbol += run;
  }
  return at;
}

/** Canonical: from the longest length to 1, by symbol among equals; the next length goes on with half the number. */
function canonicalCodes(lengths) {
  const codes = new Uint32Array(kSymbols);
  let next = 0;
  for (let length = kMaxLength; length > 0; --length) {
    for (let symbol = 0; symbol < kSymbols; ++symbol) {
      if (lengths[symbol] === length) codes[symbol] = next++;
    }
    check(next <= 2 ** length, `code lengths are over-full at ${length} bits`);
    check(next % 2 === 0 || (next === 1 && length === 1), `code lengths leave half a pair at ${length} bits`);
    next /= 2;
  }
  return codes;
}

/** Finds one symbol by its bits, which stand at the top of a 32-bit window. */
class SymbolTable {
  constructor(lengths) {
    const codes = canonicalCodes(lengths);
    this.short = new Uint16Array(1 << kIndexBits);  // length above symbol; 0: longer than the index, or none
    this.long = [];                                 // {first, length, symbol}
    for (let symbol = 0; symbol < kSymbols; ++symbol) {
      const length = lengths[symbol];
      if (length === 0) continue;
      if (length > kIndexBits) {
        this.long.push({ first: (codes[symbol] << (32 - length)) >>> 0, length, symbol });
      } else {
        const begin = codes[symbol] << (kIndexBits - length);
        this.short.fill(length << 8 | symbol, begin, begin + (1 << (kIndexBits - length)));
      }
    }
  }
  /** Length above symbol; 0 if there is no such code. */
  find(window) {
    const found = this.short[window >>> (32 - kIndexBits)];
    if (found !== 0) return found;
    const code = this.long.find(({ first, length }) => (window ^ first) >>> (32 - length) === 0);
    return code ? code.length << 8 | code.symbol : 0;
  }
}

function readHeader(header, height) {
  check(header.length >= kFixedBytes && header[3] === 0,
      `a header of ${header.length} bytes; expected that of HuffYUV 2.x`);
  const [method, bits, flags] = header;
  const predictor = method & ~kDecorrelate;
  check(predictor === kLeft || predictor === kGradient,
      `method ${method}; expected left or gradient prediction of RGB`);
  check(bits === 24 || bits === 32, `${bits} bits a pixel; expected 24 or 32`);
  check((flags & kPerFrameTables) === 0, 'tables per frame (ffvhuff) are not HuffYUV');
  const interlacing = flags & kInterlaceMask;
  const lengths = [0, 1, 2].map(() => new Uint8Array(kSymbols));
  lengths.reduce((at, table) => readLengths(header, at, table), kFixedBytes);
  return {
    gradient: predictor === kGradient,
    decorrelated: (method & kDecorrelate) !== 0,
    alpha: bits === 32,
    rowsApart: interlacing === kInterlaced || (interlacing !== kProgressive && height > kInterlacedAbove) ? 2 : 1,
    tables: lengths.map(table => new SymbolTable(table)),
  };
}

// ---- packets ----

/** Adds four bytes at once, each modulo 256. */
function addBytes(a, b) {
  return ((a & 0x7f7f7f7f) + (b & 0x7f7f7f7f)) ^ ((a ^ b) & 0x80808080);
}

/** Decodes the packets of one stream to RGBA. */
export class HuffyuvDecoder {
  #stream; #width; #height;
  #order;       // tables in the order of a pixel's codes
  #pixels;      // residuals of the pixel that begins with these kIndexBits bits
  #pixelBits;   // what it takes; 0: more than kIndexBits
  #words; #bit = 0;
  #running = 0; // the sum of the residuals so far, a pixel
  #opaque;      // the alpha of streams that have none

  /** `header`: Uint8Array, as the stream's first message has it. */
  constructor(header, width, height) {
    check(Number.isInteger(width) && Number.isInteger(height) && width > 0 && height > 0 && width <= kMaxExtent &&
        height <= kMaxExtent && width * height <= kMaxPixels, `a picture of ${width}x${height}`);
    this.#width = width;
    this.#height = height;
    this.#stream = readHeader(header, height);
    this.#opaque = this.#stream.alpha ? 0 : kOpaque;
    const [blue, green, red] = this.#stream.tables;
    this.#order = [...(this.#stream.decorrelated ? [green, blue] : [blue, green]), red,
        ...(this.#stream.alpha ? [red] : [])];
    this.#fillPixelTable();
    this.#words = new Int32Array(0);
  }

  /** A packet (Uint8Array) as Uint8ClampedArray of RGBA rows from the top; a buffer of its own. */
  decode(packet) {
    const { gradient, rowsApart } = this.#stream;
    const end = this.#load(packet);
    const width = this.#width, height = this.#height;
    const picture = new Int32Array(width * height);
    this.#running = this.#firstPixel();
    for (let coded = 0; coded < height; ++coded) {
      const vertical = gradient && coded >= rowsApart;
      const begin = (height - 1 - coded) * width;
      const skip = coded === 0 ? 1 : 0;
      if (skip) picture[begin] = this.#running | this.#opaque;
      const good = this.#readRow(picture, begin + skip, begin + width, vertical ? rowsApart * width : 0);
      check(this.#bit <= end, `a packet of ${packet.length} bytes ends in coded row ${coded} of ${height}`);
      check(good, `a code that does not exist in coded row ${coded} of ${height}`);
    }
    return new Uint8ClampedArray(picture.buffer);
  }

  /** The packet as words, with room to read a row past its end, where it is noticed. Gives its bits. */
  #load(packet) {
    const count = packet.length >> 2;
    check(count <= (this.#width * this.#height + 4) * kMostPixelWords,
        `a packet of ${packet.length} bytes; the picture has not as many`);
    const room = count + (this.#width + 1) * kMostPixelWords + 2;
    if (this.#words.length < room) this.#words = new Int32Array(room);
    const view = new DataView(packet.buffer, packet.byteOffset, packet.length);
    for (let i = 0; i < count; ++i) this.#words[i] = view.getInt32(4 * i, true);
    this.#words.fill(0, count, room);
    this.#bit = 0;
    return 32 * count;
  }

  /** Alpha red green blue, or red green blue 0. */
  #firstPixel() {
    this.#bit = 32;
    const word = this.#words[0];
    const argb = this.#stream.alpha ? word : word >>> 8;
    return (argb & 0xff00ff00) | (argb & 255) << 16 | (argb >>> 16 & 255);
  }

  /** Residuals, no longer decorrelated, as RGBA in memory. */
  #pixelOf(symbols) {
    const { decorrelated } = this.#stream;
    const green = symbols[decorrelated ? 0 : 1], blue = symbols[decorrelated ? 1 : 0];
    const more = decorrelated ? green : 0;
    return ((symbols[2] + more) & 255) | green << 8 | ((blue + more) & 255) << 16 | (symbols[3] ?? 0) << 24;
  }

  #fillPixelTable() {
    this.#pixels = new Int32Array(1 << kIndexBits);
    this.#pixelBits = new Uint8Array(1 << kIndexBits);
    const fill = (symbols, index, bits) => {
      if (symbols.length === this.#order.length) {
        const begin = index << (kIndexBits - bits), end = begin + (1 << (kIndexBits - bits));
        this.#pixels.fill(this.#pixelOf(symbols), begin, end);
        this.#pixelBits.fill(bits, begin, end);
        return;
      }
      const { short } = this.#order[symbols.length];
      // Each code that fits into what is left stands there once for every index that begins with it.
      const left = kIndexBits - bits;
      for (let at = 0; at < 1 << left;) {
        const length = short[at << bits] >> 8;
        if (length === 0 || length > left) {
          ++at;
          continue;
        }
        fill([...symbols, short[at << bits] & 255], index << length | at >> (left - length), bits + length);
        at += 1 << (left - length);
      }
    };
    fill([], 0, 0);
  }

  /** Pixels `from` to `to`; `above`: how far behind each lies the one it is predicted from, 0 for none. */
  #readRow(picture, from, to, above) {
    const words = this.#words, pixels = this.#pixels, pixelBits = this.#pixelBits, opaque = this.#opaque;
    let bit = this.#bit, running = this.#running, good = true;
    for (let i = from; i < to; ++i) {
      const word = bit >>> 5, shift = bit & 31;
      const index = (words[word] << shift | words[word + 1] >>> 1 >>> (31 - shift)) >>> (32 - kIndexBits);
      const bits = pixelBits[index];
      let residual = pixels[index];
      bit += bits;
      if (bits === 0) {
        this.#bit = bit;
        const symbols = this.#order.map(table => this.#symbol(table));
        good &&= !symbols.includes(-1);
        residual = this.#pixelOf(symbols);
        bit = this.#bit;
      }
      running = addBytes(running, residual);
      picture[i] = (above === 0 ? running : addBytes(running, picture[i + above])) | opaque;
    }
    this.#bit = bit;
    this.#running = running;
    return good;
  }

  /** The next one, or -1 where no code begins so. */
  #symbol(table) {
    const word = this.#bit >>> 5, shift = this.#bit & 31;
    const found = table.find((this.#words[word] << shift | this.#words[word + 1] >>> 1 >>> (31 - shift)) >>> 0);
    this.#bit += found >> 8;
    return found === 0 ? -1 : found & 255;
  }
}
