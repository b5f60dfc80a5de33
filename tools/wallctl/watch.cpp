// SPDX-License-Identifier: MIT
#include "tools/wallctl/watch.h"

#include <pthread.h>
#include <signal.h>
#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <iostream>

#include "tools/wallctl/columns.h"
#include "tools/wallctl/watch_text.h"

namespace wall::wallctl {
namespace {

using request::Answer;
using request::ask;

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kLimit{3};  // for an answer
constexpr std::chrono::seconds kSayBackFor{5};
// ECMA-48: cursor off and on, clear, home, erase to the end of the line and of the screen
constexpr const char* kBegin = "\x1b[?25l\x1b[2J";
constexpr const char* kEnd = "\x1b[?25h";
constexpr const char *kHome = "\x1b[H", *kEraseLine = "\x1b[K", *kEraseBelow = "\x1b[J";

std::size_t number_of(const char* variable, std::size_t otherwise) {
    const char* text = std::getenv(variable);
    const auto value = text ? std::strtoul(text, nullptr, 10) : 0;
    return value > 0 ? value : otherwise;
}

bool in_place() { return ::isatty(STDOUT_FILENO) == 1; }

/// A terminal knows its size; elsewhere only the width may be given.
Screen screen() {
    winsize size{};
    if (!in_place()) return {number_of("COLUMNS", kAnyWidth), kAnyWidth};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 1)
        return {size.ws_col, size.ws_row - 1u};
    return {number_of("COLUMNS", 80), number_of("LINES", 24) - 1};
}

/// SIGINT and SIGTERM wait until somebody looks, so that none ends it in the middle of a line.
class Signals {
public:
    Signals() {
        sigemptyset(&set_);
        sigaddset(&set_, SIGINT);
        sigaddset(&set_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &set_, nullptr);
    }
    /// Sleeps; true: one has come.
    bool sleep_until(Clock::time_point end) const {
        const auto left = std::max(Clock::duration::zero(), end - Clock::now());
        const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(left).count();
        const timespec limit{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
        return ::sigtimedwait(&set_, nullptr, &limit) > 0;
    }

private:
    sigset_t set_;
};

/// The terminal's cursor is off while this lives.
class Drawing {
public:
    explicit Drawing(bool on) : on_(on) {
        if (on_) std::cout << kBegin;
    }
    ~Drawing() {
        if (on_) std::cout << kEnd << std::flush;
    }
    Drawing(const Drawing&) = delete;

private:
    const bool on_;
};

/// What is known of the wall, refresh by refresh.
class Watch {
public:
    Watch(const Walld& walld, const Watching& watching) : walld_(walld), watching_(watching) {}

    Outcome<void> refresh() {
        const auto now = Clock::now();
        auto answer = ask(walld_, "status", json::object(), kLimit);
        if (!answer && (rated_.is_null() || answer.error().code == "forbidden")) return tl::unexpected(answer.error());
        if (answer) took(std::move(answer->json), now);
        else if (!away_since_) away_since_ = now;
        watching_.as_json ? print_json(answer) : print_text(answer, now);
        return {};
    }

private:
    void took(json status, Clock::time_point now) {
        // After an absence the counters are another process's.
        rated_ = with_rates(away_since_ ? json() : status_, status, std::chrono::duration<double>(now - at_).count());
        status_ = std::move(status);
        at_ = now;
        if (away_since_) back_ = {now, now - *away_since_};
        away_since_.reset();
    }
    void print_json(const Outcome<Answer>& answer) const {
        json out{{"time", std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count()}};
        if (answer) out["status"] = rated_;
        else out["error"] = {{"code", answer.error().code}, {"message", answer.error().message}};
        std::cout << out.dump(-1, ' ', false, json::error_handler_t::replace) << std::endl;
    }
    std::string note(const Outcome<Answer>& answer, Clock::time_point now) const {
        const auto seconds = [](Clock::duration time) { return std::chrono::duration<double>(time).count(); };
        if (!answer)
            return fmt::format("WALLD DOES NOT ANSWER for {:.0f} s; this is what it said last",
                               seconds(now - *away_since_));
        if (back_ && now - back_->first < kSayBackFor)
            return fmt::format("walld is back after {:.0f} s", seconds(back_->second));
        return fmt::format("{:%H:%M:%S}", fmt::localtime(std::time(nullptr)));
    }
    void print_text(const Outcome<Answer>& answer, Clock::time_point now) {
        const auto lines = watch_text(rated_, note(answer, now), screen());
        if (!in_place()) {
            std::cout << (std::exchange(first_, false) ? "" : "\n") << lines << std::flush;
            return;
        }
        std::string out = kHome;
        for (const char c : lines) out += c == '\n' ? std::string(kEraseLine) + "\n" : std::string(1, c);
        std::cout << out << kEraseBelow << std::flush;
    }

    const Walld& walld_;
    const Watching watching_;
    json status_, rated_;
    Clock::time_point at_{};
    std::optional<Clock::time_point> away_since_;
    std::optional<std::pair<Clock::time_point, Clock::duration>>
        back_;  ///< when it came back, and how long it was away
    bool first_ = true;
};

}  // namespace

Outcome<void> watch(const Walld& walld, const Watching& watching) {
    const Signals signals;
    Watch watch(walld, watching);
    const Drawing drawing(in_place() && !watching.as_json);
    Outcome<void> good;
    auto next = Clock::now();
    for (std::uint64_t i = 0; good && (watching.count == 0 || i < watching.count); ++i) {
        if (i > 0 && signals.sleep_until(next)) break;
        good = watch.refresh();
        next = std::max(Clock::now(), next + watching.interval);
        if (!std::cout) break;  // nobody reads it any more
    }
    return good;
}

}  // namespace wall::wallctl
