// SPDX-License-Identifier: MIT
// What the library says. It is silent unless WALLGL_LOG=LEVEL[:FILE] is set (error, warn, info, debug; stderr without
// FILE), but for complain_once(). Events read `event key=value`. Any thread.
#pragma once

#include <atomic>
#include <string>

namespace wall::client {

enum class LogLevel : int { silent = 0, error, warn, info, debug };

namespace detail {
extern std::atomic<int> log_level;  ///< -1: the environment has not been read yet
int read_log_environment();
}  // namespace detail

inline bool log_enabled(LogLevel level) {
    const int now = detail::log_level.load(std::memory_order_relaxed);
    return static_cast<int>(level) <= (now >= 0 ? now : detail::read_log_environment());
}

/// One line; the format is printf's. A text that is not our own is given as in_quotes() (common/base/quoted.h); a test
/// looks at all calls.
[[gnu::format(printf, 2, 3)]] void log(LogLevel level, const char* format, ...);

/// A line on stderr that everybody sees, at most once per process for each topic (a string literal). Goes to the log
/// as well. The text may hold anybody's words: what is not printable is escaped.
void complain_once(const std::string& text, const char* topic = "wall");

}  // namespace wall::client
