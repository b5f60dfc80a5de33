// SPDX-License-Identifier: MIT
#include "client_lib/process/log.h"

#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <mutex>
#include <string_view>

#include "common/base/quoted.h"

namespace wall::client {

namespace detail {
std::atomic<int> log_level{-1};
}

namespace {

constexpr std::array<const char*, 5> kNames{"silent", "error", "warn", "info", "debug"};
constexpr std::size_t kMaxLine = 1024;

std::atomic<int> log_fd{STDERR_FILENO};
constinit std::mutex environment_mutex;

int level_of(std::string_view name) {
    for (std::size_t i = 0; i < kNames.size(); ++i)
        if (name == kNames[i]) return static_cast<int>(i);
    return name.empty() || name == "0" ? 0 : static_cast<int>(LogLevel::info);
}

}  // namespace

int detail::read_log_environment() {
    std::lock_guard lock(environment_mutex);
    if (log_level >= 0) return log_level;
    const char* text = secure_getenv("WALLGL_LOG");
    const std::string_view value = text ? text : "";
    const auto colon = value.find(':');
    if (colon != value.npos) {
        const int fd = open(text + colon + 1, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
        if (fd >= 0) log_fd = fd;
    }
    log_level = level_of(value.substr(0, colon));
    return log_level;
}

void log(LogLevel level, const char* format, ...) {
    if (!log_enabled(level)) return;
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    char line[kMaxLine];
    int used = snprintf(line, sizeof line, "wallgl %ld.%03ld %d %-5s ", static_cast<long>(now.tv_sec),
                        now.tv_nsec / 1000000, static_cast<int>(syscall(SYS_gettid)), kNames[static_cast<int>(level)]);
    va_list arguments;
    va_start(arguments, format);
    used += vsnprintf(line + used, sizeof line - static_cast<std::size_t>(used) - 1, format, arguments);
    va_end(arguments);
    auto size = std::min(static_cast<std::size_t>(used), sizeof line - 2);
    line[size++] = '\n';
    [[maybe_unused]] const auto n = write(log_fd, line, size);
}

void complain_once(const std::string& text, const char* topic) {
    static constinit std::mutex mutex;
    static constinit std::array<const char*, 16> said{};
    {
        std::lock_guard lock(mutex);
        for (auto& entry : said) {
            if (entry && strcmp(entry, topic) == 0) return;
            if (!entry) {
                entry = topic;
                break;
            }
        }
    }
    const std::string harmless = escaped(text);
    const std::string line = "wallgl: " + harmless + "\n";
    [[maybe_unused]] const auto n = write(STDERR_FILENO, line.data(), line.size());
    if (log_fd != STDERR_FILENO) log(LogLevel::error, "%s", harmless.c_str());
}

}  // namespace wall::client
