// SPDX-License-Identifier: MIT
// The daemons' log: events, `event key=value ...`, a line each, on standard error. Takes numbers, and texts only as
// quoted() or plain(): a name that is given as it is does not compile. Any thread.
#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>

#include "common/log/quoted.h"

namespace wall::log {

template <class T>
concept Harmless = std::is_arithmetic_v<T> || std::same_as<T, Quoted> || std::same_as<T, Plain>;

enum class Level { info, warn, error };

/// One line.
void write(Level level, std::string_view line);
/// From now on lines begin with `name`, and with the time unless journald adds that. A crash leaves its
/// stack there (last_words.h).
void begin(const std::string& name);

template <Harmless... Args>
void info(fmt::format_string<const Args&...> format, const Args&... args) {
    write(Level::info, fmt::format(format, args...));
}
template <Harmless... Args>
void warn(fmt::format_string<const Args&...> format, const Args&... args) {
    write(Level::warn, fmt::format(format, args...));
}
template <Harmless... Args>
void error(fmt::format_string<const Args&...> format, const Args&... args) {
    write(Level::error, fmt::format(format, args...));
}

}  // namespace wall::log
