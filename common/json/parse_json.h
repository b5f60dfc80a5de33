// SPDX-License-Identifier: MIT
// The one way in for JSON that somebody else wrote. nlohmann::json writes and compares values by recursion, so a text
// of some hundred kilobytes of brackets would take all of a thread's stack: depth and size meet a limit before it is
// parsed. tests/unit/foreign_text_test.py sees to it that nothing else parses. Pure; any thread.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/base/result.h"

namespace wall {

struct JsonLimits {
    std::size_t bytes = 0;  ///< of the whole text
    std::size_t depth = 0;  ///< of arrays and objects in each other
};

/// An operator's command, a change over HTTP, what a viewer asks to watch.
inline constexpr JsonLimits kRequestJson{64 << 10, 16};
/// A file that walld keeps.
inline constexpr JsonLimits kFileJson{4 << 20, 16};
/// What walld answers or says in a stream: as large as its wall, and not trusted blindly.
inline constexpr JsonLimits kAnswerJson{256 << 20, 32};

/// The error says what was expected: "JSON: expected at most 16 levels ...".
Result<nlohmann::json> parse_json(std::string_view text, const JsonLimits& limits);

}  // namespace wall
