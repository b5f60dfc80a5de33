// SPDX-License-Identifier: MIT
// The format of codec `huffyuv-tiles`, shared by its encoder and decoder: blocks, their modes, and the symbols of the
// prefix codes. docs/codecs.md has the grammar. Values; any thread.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "common/codec/frame.h"
#include "common/codec/row_kernels.h"

namespace wall::codec::tiles {

inline constexpr std::uint32_t kBlock = 64;  ///< pixels a side; a slice is one row of blocks
inline constexpr std::size_t kBlockPixels = std::size_t{kBlock} * kBlock;

/// Bits of a packet's first byte.
inline constexpr std::uint8_t kKey = 1, kUnchanged = 2, kTables = 4;

enum class Mode : std::uint8_t {
    unchanged = 0,  ///< as in the picture before; not in key packets
    flat = 1,       ///< every pixel is the one left of the block's first
    raw = 2,        ///< bytes 0, 1, 2 of every pixel; alpha 255
    raw_alpha = 3,  ///< all four bytes
    left = 4,       ///< coded residuals, by predictor
    gradient = 5,
    median = 6,
    previous = 7,  ///< the same pixel of the picture before; not in key packets
};
inline constexpr unsigned kModeBits = 4;
inline constexpr std::uint8_t kWithAlpha =
    4;  ///< added to left ... previous: alpha's residual follows every whole pixel
inline constexpr std::uint8_t kModes = 12;
constexpr bool has_alpha(std::uint8_t coded_mode) { return coded_mode >= 8; }

inline constexpr std::uint32_t kOpaqueBlack = 0xff000000;  ///< left of a slice's first pixel

// Symbols of the main code. The first 256 are green's residual, and blue's and red's codes follow. Residuals of all
// three colours are one symbol when each is -1 to 2, or when blue and red are zero (grey, where all change alike); runs
// of zero pixels are one.
inline constexpr std::uint32_t kSmall = 256;         ///< + three digits of two bits
inline constexpr std::uint32_t kGrey = kSmall + 64;  ///< + green's residual
inline constexpr std::uint32_t kRuns = kGrey + 256;  ///< + run class
inline constexpr std::uint32_t kRest = kRuns + 32;   ///< zero to the block's end
inline constexpr std::size_t kMainSymbols = kRest + 1;
inline constexpr unsigned kLongestCode = 12;  ///< bits; four codes and their pixel fit a refill of 56
inline constexpr std::array<std::size_t, 4> kSymbols{kMainSymbols, 256, 256, 256};  ///< main (green), blue, red, alpha
inline constexpr std::size_t kMain = 0, kBlue = 1, kRed = 2, kAlpha = 3;

/// The digits of a residual if each colour is -1 to 2 and alpha 0; else 64 or more.
inline std::uint32_t small_digits(std::uint32_t residual) {
    const std::uint32_t raised = ((residual & 0x7f7f7f7f) + 0x00010101) ^ (residual & 0x80808080);
    if ((raised & 0xfffcfcfc) != 0) return 64;
    return (raised & 3) | (raised >> 6 & 12) | (raised >> 12 & 48);
}

/// A run of 1 to kBlockPixels as class and bits within the class: runs to 16 have a class each, longer ones two a power
/// of two.
struct RunClass {
    std::uint32_t symbol;
    std::uint32_t extra;
    unsigned extra_bits;
};
inline RunClass run_class(std::uint32_t run) {
    const std::uint32_t value = run - 1;
    if (value < 16) return {value, 0, 0};
    const auto power = static_cast<unsigned>(std::bit_width(value)) - 1;
    const std::uint32_t half = value >> (power - 1) & 1;
    return {16 + 2 * (power - 4) + half, value & ((1u << (power - 1)) - 1), power - 1};
}

/// A block's place. Slices are independent, so that nothing above `y` or left of the picture is known.
struct Block {
    std::uint32_t x, y, width, height;  ///< pixels
};
inline Block block_at(const StreamFormat& format, std::uint32_t column, std::uint32_t slice) {
    const std::uint32_t x = column * kBlock, y = slice * kBlock;
    return {x, y, std::min(kBlock, format.width - x), std::min(kBlock, format.height - y)};
}
inline std::uint32_t blocks_across(const StreamFormat& format) { return (format.width + kBlock - 1) / kBlock; }
inline std::uint32_t slices_of(const StreamFormat& format) { return (format.height + kBlock - 1) / kBlock; }

inline std::uint32_t load_pixel(const std::byte* at) {
    std::uint32_t pixel;
    std::memcpy(&pixel, at, sizeof pixel);
    return pixel;
}

/// What lies left of a block's row: beyond the picture's edge the pixel above, and above the slice opaque black. `row`
/// is at the block's first pixel; `above` is null in the slice's first row.
inline RowStart row_start(const std::byte* row, const std::byte* above, std::uint32_t x) {
    if (x > 0) return {load_pixel(row - 4), above != nullptr ? load_pixel(above - 4) : 0};
    if (above != nullptr) return {load_pixel(above), load_pixel(above)};
    return {kOpaqueBlack, 0};
}

}  // namespace wall::codec::tiles
