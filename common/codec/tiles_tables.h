// SPDX-License-Identifier: MIT
// The prefix codes of `huffyuv-tiles`: canonical, at most kLongestCode bits, in the packet as their lengths. Values;
// any thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/base/result.h"
#include "common/codec/byte_bits.h"
#include "common/codec/tiles_format.h"

namespace wall::codec::tiles {

/// One length for each symbol of each code; 0: not used.
using Lengths = std::array<std::vector<std::uint8_t>, 4>;
/// How often each symbol is used.
struct Counts {
    std::array<std::uint32_t, kMainSymbols> main{};
    std::array<std::array<std::uint32_t, 256>, 3> others{};  ///< blue, red, alpha

    std::span<const std::uint32_t> of(std::size_t code) const;
    void add(const Counts& other);
    bool empty() const;  ///< no main symbol, hence none at all
};

Lengths suit(const Counts& counts);
/// Bits that the counted symbols take; a symbol without a code makes it more than any packet.
std::uint64_t bits_with(const Counts& counts, const Lengths& lengths);

/// Room for write_lengths(), 8 bytes to spare.
inline constexpr std::size_t kMostTableBytes = (kMainSymbols + 3 * 256) / 2 + 16;
void write_lengths(const Lengths& lengths, ByteBitWriter& to);
Result<Lengths> read_lengths(ByteBitReader& from);

/// One code as an encoder uses it: for each symbol its bits above 8 bits of length.
using EncodeTable = std::array<std::uint32_t, kMainSymbols>;
std::array<EncodeTable, 4> encode_tables(const Lengths& lengths);

/// All codes as a decoder uses them: by the next kLongestCode bits.
struct DecodeTables {
    /// Symbols but green are all done alike: the value is a pixel's residual, then `advance` and what the extra bits
    /// say more pixels follow it that are zero.
    struct Main {
        std::uint32_t value;    ///< the small residual (not decorrelated any more), 0 for runs; or green
        std::uint16_t advance;  ///< pixels; 0 for green, and for bits that are no code
        std::uint8_t length;    ///< 0: no such code
        std::uint8_t extra_bits;
    };
    static constexpr std::uint16_t kToTheEnd = 1u << 15;  ///< advance of the symbol kRest
    struct Other {
        std::uint8_t symbol;
        std::uint8_t length;  ///< 0: no such code
    };
    std::array<Main, 1 << kLongestCode> main;
    std::array<std::array<Other, 1 << kLongestCode>, 3> others;  ///< blue, red, alpha
};
/// Fails when lengths make no prefix code.
Result<std::unique_ptr<DecodeTables>> decode_tables(const Lengths& lengths);

}  // namespace wall::codec::tiles
