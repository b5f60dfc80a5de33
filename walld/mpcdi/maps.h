// SPDX-License-Identifier: MIT
// The maps of an MPCDI file: fields of places as portable float maps (PFM), factors of light as PNG. Pure; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace wall::mpcdi {

inline constexpr std::uint32_t kMaxExtent = 16384;               ///< places a side
inline constexpr std::size_t kMaxPlaces = std::size_t{1} << 25;  ///< of a map

/// Three numbers for each place, row by row from the top left corner; NaN: nothing is shown there.
struct Field {
    using Value = std::array<float, 3>;
    std::uint32_t width = 0, height = 0;
    std::vector<Value> values;
    const Value& at(std::uint32_t x, std::uint32_t y) const { return values[std::size_t{y} * width + x]; }
    Value& at(std::uint32_t x, std::uint32_t y) { return values[std::size_t{y} * width + x]; }
};

/// One number, or one each of red, green and blue, for each place: 0 to 1.
struct Factors {
    std::uint32_t width = 0, height = 0, channels = 0;
    std::vector<float> values;
};

/// `what` begins the error.
Result<Field> parse_pfm(std::string_view bytes, const std::string& what);
/// Of 8 or 16 bits a channel, grey or coloured; alpha is left out.
Result<Factors> parse_png(std::string_view bytes, const std::string& what);

}  // namespace wall::mpcdi
