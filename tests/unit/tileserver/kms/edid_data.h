// SPDX-License-Identifier: MIT
// What a monitor would send of itself.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <string_view>

namespace wall::tileserver::test {

using EdidData = std::array<std::uint8_t, 128>;
inline constexpr std::size_t kSecondDescriptor = 72;

/// Of the maker DEL, product 0xa0b1, without a name.
inline EdidData edid_without_name() {
    constexpr std::array<std::uint8_t, 12> kBeginning = {0,    0xff, 0xff, 0xff, 0xff, 0xff,
                                                         0xff, 0x00, 0x10, 0xac, 0xb1, 0xa0};
    EdidData out{};
    std::ranges::copy(kBeginning, out.begin());
    return out;
}

/// `kind`: 0xfc is the monitor's name. `text`: at most 13 characters.
inline void add_text(EdidData& data, std::uint8_t kind, std::string_view text, std::size_t at = kSecondDescriptor) {
    data[at + 3] = kind;
    std::ranges::copy(text, data.begin() + static_cast<std::ptrdiff_t>(at) + 5);
}

/// So that all bytes add up to `sum`.
inline void put_sum_right(EdidData& data, std::uint8_t sum = 0) {
    data.back() = static_cast<std::uint8_t>(sum - std::accumulate(data.begin(), data.end() - 1, 0));
}

}  // namespace wall::tileserver::test
