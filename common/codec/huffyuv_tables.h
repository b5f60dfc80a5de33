// SPDX-License-Identifier: MIT
// Tables that turn HuffYUV's bits back into residuals: one symbol at a time for any code, and whole pixels, up to two
// at a time, for short codes. Built once a stream. Pure; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/codec/frame.h"
#include "common/codec/huffyuv_format.h"
#include "common/codec/word_bits.h"

namespace wall::codec::huffyuv {

inline constexpr unsigned kIndexBits = 12;

/// One code. Every symbol of a complete code is found; gaps of an incomplete one set failed().
class SymbolTable {
public:
    explicit SymbolTable(const std::array<Code, 256>& codes);

    /// The next symbol; refills.
    std::uint8_t take(WordBitReader& from, bool& failed) const {
        from.refill();
        const std::uint16_t found = short_[from.peek(kIndexBits)];
        if (found == 0) [[unlikely]]
            return take_long(from, failed);
        from.skip(found >> 8);
        return static_cast<std::uint8_t>(found);
    }

private:
    struct Long {
        std::uint32_t first;  ///< the code's bits, highest first
        std::uint8_t length;
        std::uint8_t symbol;
    };
    std::uint8_t take_long(WordBitReader& from, bool& failed) const;

    std::vector<std::uint16_t> short_;  ///< by kIndexBits bits: length above symbol; 0: longer or none
    std::vector<Long> long_;            ///< in rising order of `first`
};

/// What the next kIndexBits bits say of pixels. Residuals are no longer decorrelated; alpha is 0 where the stream has
/// none.
struct PixelEntry {
    std::array<std::uint32_t, 2> pixels{};
    std::uint8_t bits = 0;   ///< of both
    std::uint8_t count = 0;  ///< 0: not even one pixel is whole
    std::uint8_t first_bits = 0;
};

/// How a pixel's bytes are put together.
struct PixelOrder {
    bool decorrelated;
    bool alpha;
    unsigned red_shift;  ///< 16 for bgra, 0 for rgba

    std::uint32_t pixel(std::uint32_t blue, std::uint32_t green, std::uint32_t red, std::uint32_t alpha_byte) const {
        const std::uint32_t more = decorrelated ? green : 0;
        return ((blue + more) & 255) << (16 - red_shift) | green << 8 | ((red + more) & 255) << red_shift |
               alpha_byte << 24;
    }
};

std::vector<PixelEntry> pixel_entries(const Tables& tables, const PixelOrder& order);

}  // namespace wall::codec::huffyuv
