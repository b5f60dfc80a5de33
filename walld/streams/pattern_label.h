// SPDX-License-Identifier: MIT
// The words that a tile shows of itself (`wallctl pattern names`). Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace wall::walld {

struct PatternLabel {
    std::uint32_t width = 0, height = 0;
    std::string bytes;  ///< brightness, row by row
};
/// One line below the other; what is no ASCII is a question mark. Long lines are cut.
PatternLabel pattern_label(const std::vector<std::string>& lines);

}  // namespace wall::walld
