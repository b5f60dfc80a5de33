// SPDX-License-Identifier: MIT
// What a HuffYUV stream is besides its pixels: the bytes behind AVI's BITMAPINFOHEADER (HuffYUV 2.x), or its bit count
// alone (1.x). docs/codecs.md has the grammar. Values; any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/base/result.h"
#include "common/codec/huffman.h"

namespace wall::codec::huffyuv {

/// The value is the format's own number.
enum class Predictor : std::uint8_t { left = 0, gradient = 1, median = 2 };
enum class Pixels : std::uint8_t { yuy2 = 16, rgb24 = 24, rgb32 = 32 };

/// Codes of the residuals: Y, U, V, or B, G, R (alpha with R's).
using Tables = std::array<std::array<Code, 256>, 3>;

struct Stream {
    Pixels pixels = Pixels::rgb24;
    Predictor predictor = Predictor::left;
    bool decorrelate = true;  ///< RGB: blue and red are coded less green
    bool interlaced = false;  ///< predicted from two rows above
    bool classic = false;     ///< HuffYUV 1.x: built-in tables, no bytes behind the header
    Tables tables;
};

/// The codes of HuffYUV 1.x.
Tables classic_tables(Pixels pixels);

/// The bytes behind the BITMAPINFOHEADER; empty for classic streams.
std::vector<std::byte> write_extradata(const Stream& stream);
/// biBitCount of the BITMAPINFOHEADER.
std::uint16_t bit_count(const Stream& stream);

/// The stream that biBitCount and the extradata describe; `height` decides on interlacing where they do not. Fails for
/// what no HuffYUV 1.x or 2.x writes.
Result<Stream> read_stream(std::uint16_t bit_count, std::uint32_t height, std::span<const std::byte> extradata);

/// Nothing, or why frames of this kind and width do not exist.
Result<void> check(const Stream& stream, std::uint32_t width);

}  // namespace wall::codec::huffyuv
