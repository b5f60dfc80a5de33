// SPDX-License-Identifier: MIT
// Text in a line of the log. Names, titles and reasons come from programs, peers and drivers; written as they are, a
// line feed in one would begin a line of its own, and a quote a field. Pure; any thread.
#pragma once

#include <spdlog/fmt/fmt.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace wall::log {

inline constexpr std::size_t kMaxText = 512;  ///< bytes of a text that the log keeps

/// Anybody's text, made harmless: in quotes, printable ASCII, one line, bounded.
struct Quoted {
    std::string text;
};
/// Quotes, backslashes and all that is not printable ASCII become escapes; what is longer ends in "...".
Quoted quoted(std::string_view text);

/// A text that cannot hold anybody else's words: a constant of the program, or an audit line.
struct Plain {
    std::string text;
};
inline Plain plain(std::string text) { return {std::move(text)}; }

}  // namespace wall::log

template <>
struct fmt::formatter<wall::log::Quoted> : fmt::formatter<std::string_view> {
    auto format(const wall::log::Quoted& quoted, fmt::format_context& out) const {
        return fmt::formatter<std::string_view>::format(quoted.text, out);
    }
};
template <>
struct fmt::formatter<wall::log::Plain> : fmt::formatter<std::string_view> {
    auto format(const wall::log::Plain& plain, fmt::format_context& out) const {
        return fmt::formatter<std::string_view>::format(plain.text, out);
    }
};
