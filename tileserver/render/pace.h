// SPDX-License-Identifier: MIT
// How long a stream's turn on the render thread is, and when its next one may begin. Pure; one thread.
//
// A turn should cost all others about kTurn. What the render thread spends on it is only a part of that: drivers gather
// what they are told and draw later (for llvmpipe a triangle is a tenth of a microsecond to take and, if it covers a
// window, a thousand times that to fill). So a stream that has told enough waits for the driver (RenderThread does that
// and says how long it took), and then it is known what a command costs, all in all: a turn is as many as fit into it.
// It is commands that are counted, not the time that telling them takes: a driver that compiles a shader makes a turn
// long in which little was told. Turns begin small, since nobody knows yet, and grow by steps. While no other stream is
// active one waits less often, and if the driver keeps up only for what it had told when it waited last, so that the
// driver draws while more is told. A turn that could not be cut, such as one long call of the driver, is made up for:
// the stream then waits for as long, if others are active.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace wall::tileserver {

class Pace {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr Clock::duration kTurn = std::chrono::milliseconds(5);
    static constexpr Clock::duration kAlone =
        std::chrono::milliseconds(25);  ///< between two waits, if no other is active
    static constexpr Clock::duration kFirst = std::chrono::microseconds(50);  ///< what a command is first held to cost
    static constexpr int kStep = 4;  ///< the most by which a turn's commands grow at once

    /// Commands until the driver is to be waited for; the next turn ends there, or after kTurn of the render thread's
    /// time. `contended`: others are active.
    std::uint64_t commands(bool contended) const {
        const auto fit = static_cast<std::uint64_t>((contended ? kTurn : kAlone) / cost_);
        return std::max<std::uint64_t>(1, fit - std::min(fit, told_));
    }
    /// How many turns the stream gets where others get one: so much sooner a long one is made up for.
    void set_weight(double weight) { weight_ = weight; }
    /// Otherwise others come first, if there are any.
    bool may_run(Clock::time_point now) const { return now >= not_before_; }
    Clock::time_point not_before() const { return not_before_; }

    /// A turn of `told` commands took `spent` of the render thread's time. True: wait for the driver, and say so to
    /// finished().
    bool spend(Clock::duration spent, std::uint64_t told, bool contended) {
        const bool enough = told >= commands(contended);
        turn_ = spent;
        spent_ += spent;
        told_ += told;
        return enough || spent_ >= (contended ? kTurn : kAlone);
    }
    /// Whether the driver has lately needed no longer for what it was told than the stream to tell it. Known only of
    /// much: the first turns may be anything, such as a shader that is compiled.
    bool driver_keeps_up() const { return keeps_up_; }
    /// All that the stream has told the driver is done, or all that it had told the last time; that took `waited`
    /// beyond what it has spent.
    void finished(Clock::duration waited, Clock::time_point now) {
        const auto whole = std::chrono::duration<double, Clock::period>(spent_ + waited);
        cost_ = std::max({whole / static_cast<double>(std::max<std::uint64_t>(1, told_)), cost_ / kStep, kLeast});
        keeps_up_ = waited <= spent_ && spent_ >= kMuch;
        if (turn_ + waited > 2 * kTurn)
            not_before_ = now + std::chrono::duration_cast<Clock::duration>((turn_ + waited - kTurn) / weight_);
        spent_ = {};
        told_ = 0;
    }

private:
    using Cost = std::chrono::duration<double, Clock::period>;
    static constexpr Cost kLeast = std::chrono::nanoseconds(1);
    static constexpr Clock::duration kMuch = kAlone / 8;
    Cost cost_ = kFirst;                // of a command, with what the driver does for it
    Clock::duration spent_{}, turn_{};  // since the driver was waited for; in the last turn
    std::uint64_t told_ = 0;            // commands since then
    Clock::time_point not_before_{};
    double weight_ = 1;
    bool keeps_up_ = false;
};

}  // namespace wall::tileserver
