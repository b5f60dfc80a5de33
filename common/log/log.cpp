// SPDX-License-Identifier: MIT
#include "common/log/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdlib>

#include "common/log/last_words.h"

namespace wall::log {
namespace {

spdlog::level::level_enum level_of(Level level) {
    switch (level) {
        case Level::info: return spdlog::level::info;
        case Level::warn: return spdlog::level::warn;
        case Level::error: return spdlog::level::err;
    }
    return spdlog::level::err;
}

}  // namespace

void write(Level level, std::string_view line) {
    spdlog::default_logger_raw()->log(level_of(level), spdlog::string_view_t(line.data(), line.size()));
}

void begin(const std::string& name) {
    spdlog::set_default_logger(spdlog::stderr_logger_mt(name));
    spdlog::set_pattern(std::getenv("JOURNAL_STREAM") ? "%l %v" : "%Y-%m-%dT%H:%M:%S.%e %n %l %v");
    spdlog::flush_on(spdlog::level::info);
    leave_last_words(name);
}

}  // namespace wall::log
