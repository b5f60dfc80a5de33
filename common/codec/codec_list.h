// SPDX-License-Identifier: MIT
// The codecs there are, one line each: WALL_CODEC(x) is the `Codec` named codec_x, defined in the codec's own file.
// Included several times, hence no guard.
WALL_CODEC(huffyuv)
WALL_CODEC(huffyuv_tiles)
WALL_CODEC(raw)
WALL_CODEC(lz4)
WALL_CODEC(zstd)
