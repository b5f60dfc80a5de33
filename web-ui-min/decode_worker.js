// SPDX-License-Identifier: MIT
// Worker: turns the packets of streams into pictures, away from the page's thread. It is told a stream's format, then
// gets packets one at a time, each answered by {stream, bitmap} or {stream, error}.

import { HuffyuvDecoder } from './huffyuv.js';

const decoders = new Map();  // by stream: {decoder, width, height}, or {error}

function setFormat({ stream, header, width, height }) {
  try {
    decoders.set(stream, { decoder: new HuffyuvDecoder(header, width, height), width, height });
  } catch (error) {
    decoders.set(stream, { error });
  }
}

async function decode({ stream, packet }) {
  const { decoder, width, height, error } = decoders.get(stream);
  if (error) throw error;
  return createImageBitmap(new ImageData(decoder.decode(packet), width, height));
}

onmessage = async ({ data }) => {
  if (data.header) return setFormat(data);
  try {
    const bitmap = await decode(data);
    postMessage({ stream: data.stream, bitmap }, [bitmap]);
  } catch (error) {
    postMessage({ stream: data.stream, error: error.message });
  }
};
