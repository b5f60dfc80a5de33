// SPDX-License-Identifier: MIT
// Text in columns, for terminals. Pure. A character is taken to be one cell wide.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wall::wallctl {

using Row = std::vector<std::string>;

inline constexpr std::size_t kAnyWidth = std::string::npos;

/// Columns as wide as their widest cell, two blanks between them; the first row is the headings. Lines are at most
/// `width` cells: columns go where that does not suffice, the highest of `ranks` first and never rank 0, then lines are
/// cut.
std::string table(const std::vector<Row>& rows, std::span<const int> ranks = {}, std::size_t width = kAnyWidth);

/// The text cut to so many cells; the last one is an ellipsis if something is missing.
std::string cut(std::string_view text, std::size_t width);

/// The text without control characters, so that no program's name moves the cursor.
std::string printable(std::string_view text);

}  // namespace wall::wallctl
