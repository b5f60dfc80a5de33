// SPDX-License-Identifier: MIT
// Whether a turn takes longer than it may, seen by somebody who looks again and again. What counts is the time in which
// the process ran: one that was stopped for a minute (a debugger, a suspended machine) has not kept the driver for a
// minute, so between two looks at most twice the interval counts. Pure; one thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

#include "tileserver/render/running_turn.h"

namespace wall::tileserver {

class TurnWatch {
public:
    using Clock = std::chrono::steady_clock;

    explicit TurnWatch(Clock::duration longest) : longest_(longest) {}

    Clock::duration longest() const { return longest_; }
    /// When to look again.
    Clock::duration interval() const { return longest_ / kLooks; }
    /// True once for each turn that has taken too long.
    bool overdue(const std::optional<RunningTurn>& turn, Clock::time_point now) {
        const auto passed = std::min(now - looked_, 2 * interval());
        looked_ = now;
        if (!turn || !seen_ || turn->stream != seen_->stream || turn->since != seen_->since) {
            seen_ = turn;
            running_ = {};
            return false;
        }
        const bool was_overdue = running_ > longest_;
        running_ += passed;
        return !was_overdue && running_ > longest_;
    }

private:
    static constexpr int kLooks = 20;  // in the longest time that a turn may take
    Clock::duration longest_;
    Clock::time_point looked_{};
    std::optional<RunningTurn> seen_;
    Clock::duration running_{};
};

}  // namespace wall::tileserver
