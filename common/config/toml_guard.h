// SPDX-License-Identifier: MIT
// toml++ 3.3 classifies characters beyond ASCII with tables that have holes: for some of them outside of strings it
// runs into code that it declares unreachable. So it gets to see them as private-use characters of plane 16, which it
// takes for what they are there, letters of no meaning, and whatever text comes back is translated back. It trips over
// control characters, too, which TOML allows nowhere: those are looked for before. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace wall::config {

/// The line, from 1, of the first control character that is no tab or line break (TOML 1.0: not even in comments); 0:
/// there is none.
std::uint32_t control_character_line(std::string_view text);

/// Every well-formed character from U+0080 to U+FEFF moves up by 0x100000; everything else stays, ill-formed bytes too.
std::string to_private_use(std::string_view utf8);
/// The way back. A private-use character that the text itself had (none has a meaning) changes.
std::string from_private_use(std::string_view utf8);

}  // namespace wall::config
