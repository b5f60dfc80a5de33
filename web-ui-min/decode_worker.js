// SPDX-License-Identifier: MIT
// Worker: turns the packets of a stream's parts into pictures, away from the page's thread. It is told a part's size
// and header, then gets packets one at a time, each answered by {part, bitmap} or {part, error}.

import { HuffyuvDecoder } from './huffyuv.js';

const decoders = new Map();  // by part: {decoder, width, height}, or {error}

function setFormat({ part, header, width, height }) {
  try {
    decoders.set(part, { decoder: new HuffyuvDecoder(header, width, height), width, height });
  } catch (error) {
    decoders.set(part, { error });
  }
}

async function decode({ part, packet }) {
  const { decoder, width, height, error } = decoders.get(part);
  if (error) throw error;
  return createImageBitmap(new ImageData(decoder.decode(packet), width, height));
}

onmessage = async ({ data }) => {
  if (data.header) return setFormat(data);
  try {
    const bitmap = await decode(data);
    postMessage({ part: data.part, bitmap }, [bitmap]);
  } catch (error) {
    postMessage({ part: data.part, error: error.message });
  }
};
