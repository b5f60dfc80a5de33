// SPDX-License-Identifier: MIT
#include "common/codec/huffyuv_tables.h"

#include <algorithm>

namespace wall::codec::huffyuv {
namespace {

struct Short {
    std::uint32_t bits;
    unsigned length;
    std::uint32_t symbol;
};

/// The codes that leave room in an index, the shortest first.
std::vector<Short> short_codes(const std::array<Code, 256>& codes) {
    std::vector<Short> out;
    for (std::uint32_t symbol = 0; symbol < 256; ++symbol)
        if (codes[symbol].length > 0 && codes[symbol].length < kIndexBits)
            out.push_back({codes[symbol].bits, codes[symbol].length, symbol});
    std::stable_sort(out.begin(), out.end(), [](const Short& a, const Short& b) { return a.length < b.length; });
    return out;
}

/// Calls `each(code)` for the codes of at most `room` bits.
template <class Each>
void within(const std::vector<Short>& codes, unsigned room, Each each) {
    for (const Short& code : codes) {
        if (code.length > room) return;
        each(code);
    }
}

}  // namespace

SymbolTable::SymbolTable(const std::array<Code, 256>& codes) : short_(std::size_t{1} << kIndexBits, 0) {
    for (std::uint32_t symbol = 0; symbol < 256; ++symbol) {
        const Code code = codes[symbol];
        if (code.length == 0) continue;
        if (code.length > kIndexBits) {
            long_.push_back({code.bits << (32 - code.length), code.length, static_cast<std::uint8_t>(symbol)});
            continue;
        }
        const auto entry = static_cast<std::uint16_t>(code.length << 8 | symbol);
        std::fill_n(short_.begin() + (code.bits << (kIndexBits - code.length)),
                    std::size_t{1} << (kIndexBits - code.length), entry);
    }
    std::sort(long_.begin(), long_.end(), [](const Long& a, const Long& b) { return a.first < b.first; });
}

std::uint8_t SymbolTable::take_long(WordBitReader& from, bool& failed) const {
    const std::uint32_t next = from.peek(32);
    const auto after = std::upper_bound(long_.begin(), long_.end(), next,
                                        [](std::uint32_t bits, const Long& code) { return bits < code.first; });
    if (after == long_.begin() || (next ^ std::prev(after)->first) >> (32 - std::prev(after)->length) != 0) {
        failed = true;
        return 0;
    }
    from.skip(std::prev(after)->length);
    return std::prev(after)->symbol;
}

std::vector<PixelEntry> pixel_entries(const Tables& tables, const PixelOrder& order) {
    std::vector<PixelEntry> out(std::size_t{1} << kIndexBits);
    const auto blue = short_codes(tables[0]), green = short_codes(tables[1]), red = short_codes(tables[2]);
    const auto fill = [&](std::uint32_t bits, unsigned length, std::uint32_t pixel) {
        PixelEntry entry{.pixels = {pixel, 0},
                         .bits = static_cast<std::uint8_t>(length),
                         .count = 1,
                         .first_bits = static_cast<std::uint8_t>(length)};
        std::fill_n(out.begin() + (bits << (kIndexBits - length)), std::size_t{1} << (kIndexBits - length), entry);
    };
    const auto& first = order.decorrelated ? green : blue;
    const auto& second = order.decorrelated ? blue : green;
    within(first, kIndexBits, [&](const Short& a) {
        within(second, kIndexBits - a.length, [&](const Short& b) {
            within(red, kIndexBits - a.length - b.length, [&](const Short& c) {
                const std::uint32_t bits = (a.bits << b.length | b.bits) << c.length | c.bits;
                const unsigned length = a.length + b.length + c.length;
                const auto b_symbol = order.decorrelated ? b.symbol : a.symbol,
                           g_symbol = order.decorrelated ? a.symbol : b.symbol;
                if (!order.alpha) return fill(bits, length, order.pixel(b_symbol, g_symbol, c.symbol, 0));
                within(red, kIndexBits - length, [&](const Short& d) {
                    fill(bits << d.length | d.bits, length + d.length,
                         order.pixel(b_symbol, g_symbol, c.symbol, d.symbol));
                });
            });
        });
    });
    const auto single = out;
    for (std::uint32_t index = 0; index < out.size(); ++index) {
        PixelEntry& entry = out[index];
        const PixelEntry& next = single[(index << entry.bits) & (out.size() - 1)];
        if (entry.count == 0 || next.count == 0 || entry.bits + next.bits > kIndexBits) continue;
        entry = {{entry.pixels[0], next.pixels[0]}, static_cast<std::uint8_t>(entry.bits + next.bits), 2, entry.bits};
    }
    return out;
}

}  // namespace wall::codec::huffyuv
