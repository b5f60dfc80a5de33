// SPDX-License-Identifier: MIT
// Text of others in a line that we write. Names, titles and reasons come from programs, peers and drivers; written as
// they are, a line feed in one would begin a line of its own, a quote a field, and an escape would colour a terminal.
// Pure; any thread.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace wall {

inline constexpr std::size_t kMaxQuoted = 512;  ///< bytes of a text that is kept

/// Printable ASCII on one line: quotes, backslashes and all else become escapes; what is longer ends in "...".
std::string escaped(std::string_view text);
/// The same in quotes: a field of the log.
std::string in_quotes(std::string_view text);

}  // namespace wall
