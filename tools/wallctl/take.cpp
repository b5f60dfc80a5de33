// SPDX-License-Identifier: MIT
#include "tools/wallctl/take.h"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tools/wallctl/interrupts.h"
#include "tools/wallctl/own_wall.h"

namespace wall::wallctl {
namespace {

using nlohmann::json;
using request::Answer;
using request::ask;
using request::failed;
using request::Outcome;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kTold{10}, kMoveLimit{40}, kComes{10}, kEnds{3};
constexpr std::chrono::milliseconds kEach{200};

/// A window of the program: its number in the session, and the X window.
struct ProgramWindow {
    std::uint64_t surface = 0;
    Covered covered;
    bool operator==(const ProgramWindow&) const = default;
};

std::vector<ProgramWindow> windows_of(const json& session) {
    std::vector<ProgramWindow> out;
    for (const auto& surface : session.at("surfaces")) {
        const auto& native = surface.at("x_window");
        const std::string id = surface.at("id");
        if (native.is_null()) continue;
        out.push_back({std::stoull(id.substr(id.find('.') + 1)),
                       {native.at("display"), native.at("id"), surface.at("width"), surface.at("height")}});
    }
    return out;
}

std::vector<Covered> covered_by(const std::vector<ProgramWindow>& windows) {
    std::vector<Covered> out;
    for (const auto& window : windows) out.push_back(window.covered);
    return out;
}

std::string own_user() {
    const passwd* const user = ::getpwuid(::geteuid());
    return user != nullptr ? user->pw_name : std::to_string(::geteuid());
}

/// The session of the program with that process id, if it is there.
Outcome<std::optional<json>> session_of(const request::Walld& walld, const json& pid) {
    const auto answer = ask(walld, "sessions", json::object(), kTold);
    if (!answer) return tl::unexpected(answer.error());
    for (const auto& session : answer->json)
        if (session.at("pid") == pid && !session.at("surfaces").empty()) return std::optional(session);
    return std::optional<json>();
}

/// The same, once it has come.
Outcome<json> await(const request::Walld& walld, const json& pid) {
    for (const auto until = Clock::now() + kComes; Clock::now() < until; std::this_thread::sleep_for(kEach)) {
        auto session = session_of(walld, pid);
        if (!session) return tl::unexpected(session.error());
        if (*session) return std::move(**session);
    }
    return failed("the program has not come where it has gone to");
}

Outcome<void> move(const request::Walld& from, const json& session, const request::Walld& to) {
    const auto answer = ask(from, "move", {{"id", session}, {"to", to.address}}, kMoveLimit);
    if (!answer) return tl::unexpected(answer.error());
    return {};
}

/// Why it cannot be taken; nothing: it can.
std::string refusal(const request::Walld& walld, const json& session) {
    if (!walld.address.starts_with("unix:"))
        return "walld at " + walld.address +
               ": expected its socket on the program's machine (--walld unix:PATH), "
               "through which the program comes back";
    const auto& owner = session.at("owner");
    if (owner.at("kind") != "user" || owner.at("name") != own_user())
        return fmt::format("the program is of {} {}: expected one of {}, whose windows this can draw in",
                           owner.at("kind").get<std::string>(), owner.at("name").get<std::string>(), own_user());
    const auto windows = windows_of(session);
    if (windows.empty()) return "the program has no window of an X server";
    for (const auto& window : windows)
        if (window.covered.display != windows.front().covered.display)
            return "the program has windows on several X displays: expected one";
    return "";
}

/// The program while it is in its own windows.
class Taken {
public:
    Taken(OwnWall wall, json pid, std::vector<ProgramWindow> windows)
        : wall_(std::move(wall)), pid_(std::move(pid)), windows_(std::move(windows)) {}

    Outcome<void> begin() {
        const auto session = await(wall_.walld(), pid_);
        if (!session) return tl::unexpected(session.error());
        session_ = session->at("id");
        return place();
    }
    /// False: the program has ended.
    Outcome<bool> look() {
        const auto session = session_of(wall_.walld(), pid_);
        if (!session) return tl::unexpected(session.error());
        if (!*session) return false;
        if (auto alive = wall_.check(); !alive) {  // perhaps with the program's windows, just before the program
            if (const auto ended = has_ended(); !ended || !*ended) return tl::unexpected(alive.error());
            return false;
        }
        auto now = windows_of(**session);
        if (now.empty() || now == windows_) return true;
        windows_ = std::move(now);
        if (auto resized = wall_.resize(covered_by(windows_)); !resized) return tl::unexpected(resized.error());
        if (auto placed = place(); !placed) return tl::unexpected(placed.error());
        return true;
    }
    /// The number that it has on the wall again.
    Outcome<json> go_back(const request::Walld& walld) {
        if (auto moved = move(wall_.walld(), session_, walld); !moved) return tl::unexpected(moved.error());
        const auto session = await(walld, pid_);
        if (!session) return tl::unexpected(session.error());
        return session->at("id");
    }

private:
    /// The program has, or will have in a moment.
    Outcome<bool> has_ended() const {
        for (const auto until = Clock::now() + kEnds; Clock::now() < until; std::this_thread::sleep_for(kEach)) {
            const auto session = session_of(wall_.walld(), pid_);
            if (!session) return tl::unexpected(session.error());
            if (!*session) return true;
        }
        return false;
    }
    /// Each window on its tile, pixel for pixel.
    Outcome<void> place() {
        for (std::size_t i = 0; i < windows_.size(); ++i) {
            const auto& window = windows_[i].covered;
            const json rect{own_wall_left(covered_by(windows_), i), 0, window.width, window.height};
            const auto id = fmt::format("{}.{}", session_.get<std::uint64_t>(), windows_[i].surface);
            const auto placed = ask(wall_.walld(), "place", {{"id", id}, {"rect", rect}}, kTold);
            if (!placed) return tl::unexpected(placed.error());
        }
        return {};
    }

    OwnWall wall_;
    const json pid_;
    json session_;  ///< its number there
    std::vector<ProgramWindow> windows_;
};

}  // namespace

Outcome<Answer> take(const request::Walld& walld, const Take& options) {
    const auto session = ask(walld, "session", {{"id", options.session}}, kTold);
    if (!session) return tl::unexpected(session.error());
    if (const auto why = refusal(walld, session->json); !why.empty()) return failed(why);
    const auto windows = windows_of(session->json);
    auto own = OwnWall::start(covered_by(windows));
    if (!own) return tl::unexpected(own.error());
    watch_for_interrupts();
    if (auto moved = move(walld, options.session, own->walld()); !moved) return tl::unexpected(moved.error());
    Taken taken(std::move(*own), session->json.at("pid"), windows);
    const auto begin = Clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    /// The program is not lost with its own wall.
    const auto give_back = [&](const request::Failure& why) -> Outcome<Answer> {
        const auto back = taken.go_back(walld);
        if (!back) return tl::unexpected(why);
        return Answer{{{"session", *back}, {"seconds", seconds()}, {"ended", why.message}}, {}};
    };
    if (auto begun = taken.begin(); !begun) return give_back(begun.error());
    if (options.progress) std::cerr << "It is in its own window now. Ctrl-C puts it back on the wall.\n";
    std::size_t answered = 0;  // times that it was to go back, and could not
    for (;; std::this_thread::sleep_for(kEach)) {
        const auto goes_on = taken.look();
        if (!goes_on) return give_back(goes_on.error());
        if (!*goes_on)
            return Answer{{{"session", nullptr}, {"seconds", seconds()}, {"ended", "the program has ended"}}, {}};
        const bool over = options.seconds > 0 && seconds() >= options.seconds;
        const std::size_t asked = interruptions() + (over ? 1 : 0);
        if (asked == answered) continue;
        auto back = taken.go_back(walld);
        if (back)
            return Answer{{{"session", *back}, {"seconds", seconds()}, {"ended", over ? "time" : "interrupted"}}, {}};
        if (std::exchange(answered, asked) != 0) return tl::unexpected(back.error());
        if (options.progress)
            std::cerr << "The wall does not take it back: " << back.error().message
                      << "\nIt stays in its window. Ctrl-C tries again, and ends its drawing if it cannot go.\n";
    }
}

}  // namespace wall::wallctl
