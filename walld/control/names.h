// SPDX-License-Identifier: MIT
// Names that people give to what walld keeps. Pure.
#pragma once

#include <cstddef>
#include <string>

namespace wall::walld {

inline constexpr std::size_t kMaxName = 64;  ///< bytes

/// What may be a file's name as it is: ASCII letters, digits, dots, dashes and underscores, and no dot at the
/// beginning.
bool may_name_file(const std::string& name);
/// That rule for whoever broke it: what such a name has.
std::string file_name_rule();

}  // namespace wall::walld
