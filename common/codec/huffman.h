// SPDX-License-Identifier: MIT
// Prefix codes: lengths from counts (Huffman 1952, with a limit on the length), and the canonical code of HuffYUV.
// Pure; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/result.h"

namespace wall::codec {

/// Lengths of a complete prefix code for the symbols with a count, none longer than `limit` bits; 0 for the others. One
/// symbol alone gets 1 bit. At most 2^limit symbols may have a count.
std::vector<std::uint8_t> huffman_lengths(std::span<const std::uint32_t> counts, unsigned limit);

struct Code {
    std::uint32_t bits = 0;   ///< the code's value, its first bit highest
    std::uint8_t length = 0;  ///< 0: the symbol has no code
};

/// HuffYUV's canonical codes: the longest first from zero, and among equals by symbol. Fails when the lengths are over
/// 31 or make no prefix code.
Result<std::vector<Code>> canonical_codes(std::span<const std::uint8_t> lengths);

}  // namespace wall::codec
