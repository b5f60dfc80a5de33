// SPDX-License-Identifier: MIT
// Text in a line of the daemons' log, as types, so that none gets there as it is. Pure; any thread.
#pragma once

#include <spdlog/fmt/fmt.h>

#include <string>
#include <string_view>

#include "common/base/quoted.h"

namespace wall::log {

/// Anybody's text, made harmless (common/base/quoted.h).
struct Quoted {
    std::string text;
};
inline Quoted quoted(std::string_view text) { return {in_quotes(text)}; }

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
