// SPDX-License-Identifier: MIT
// Whether what goes to a node is coded (common/wire/history_coder.h). That pays where the link is what a program waits
// for; where it is the node, or nothing, it only costs. What it is nobody can see from here: between them stand
// sockets, an agent, encryption. So where a program waits for a node it is tried, and judged by what the node has got
// in a while, counted as it was packed: coded must be kBetter times as much as plain was, or it be waited for no
// longer. What did not pay is tried again later, ever more rarely; at once where the node gets much less than it did
// then, which a link does that has become slow. Pure; the time is an argument.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <optional>

#include "client_lib/process/options.h"

namespace wall::client {

class CodingChoice {
public:
    using Clock = std::chrono::steady_clock;
    using Time = Clock::time_point;

    static constexpr std::chrono::milliseconds kWindow{500};  ///< that is measured at least
    static constexpr double kLimit = 0.5;                     ///< share of it that was waited: the link may be slow
    static constexpr double kBusy = 0.8;                      ///< share of it that went to coding: that may be slow
    static constexpr double kBetter = 1.2;
    static constexpr double kMuchLess = 0.5;  ///< than at the last trial: it says nothing any more
    static constexpr std::chrono::seconds kFirstPause{10}, kLongestPause{300};

    explicit CodingChoice(Coding coding) : coding_(coding) {}

    bool codes() const {
        if (coding_ != Coding::measured) return coding_ == Coding::always;
        return state_ == State::coded || state_ == State::coded_on_trial;
    }

    void coding_took(Clock::duration time) { coder_ += time; }

    /// The node has got a batch of so many bytes, as they were before coding. `waited`: how long it was waited for so
    /// far, since the stream's beginning.
    void delivered(std::size_t bytes, bool coded, Time now, Clock::duration waited) {
        if (coding_ != Coding::measured || coded != codes()) return;  // of before the last change: it was on its way
        waited_ = waited;
        if (!begin_) return begin(now);
        bytes_ += static_cast<double>(bytes);
        if (now - *begin_ >= kWindow) judge(std::chrono::duration<double>(now - *begin_).count(), now);
    }

private:
    enum class State { plain, coded_on_trial, coded, plain_on_trial };

    void begin(Time now) {
        begin_ = now;
        bytes_ = 0;
        waited_before_ = waited_;
        coder_ = {};
    }
    void go(State state, Time now) {
        state_ = state;
        if (state == State::coded_on_trial || state == State::plain_on_trial) begin_.reset();  // until that comes
        else begin(now);
    }
    void judge(double seconds, Time now) {
        const double rate = bytes_ / seconds;
        const bool waits = std::chrono::duration<double>(waited_ - waited_before_).count() > kLimit * seconds;
        const bool coder_is_busy = std::chrono::duration<double>(coder_).count() > kBusy * seconds;
        switch (state_) {
            case State::plain:
            case State::coded: {
                const bool doubt = state_ == State::plain ? waits : coder_is_busy;
                const bool much_less = state_ == State::plain && rate < kMuchLess * before_;
                if (!doubt || (now < next_trial_ && !much_less)) return begin(now);
                if (much_less) pause_ = kFirstPause;
                before_ = rate;
                return go(state_ == State::plain ? State::coded_on_trial : State::plain_on_trial, now);
            }
            case State::coded_on_trial:
                return settle(!waits || rate > kBetter * before_, State::coded, State::plain, now);
            case State::plain_on_trial: return settle(rate > kBetter * before_, State::plain, State::coded, now);
        }
    }
    void settle(bool better, State next, State back, Time now) {
        next_trial_ = now + pause_;
        pause_ = better ? kFirstPause : std::min(2 * pause_, kLongestPause);
        go(better ? next : back, now);
    }

    const Coding coding_;
    State state_ = State::plain;
    std::optional<Time> begin_;                   // of the window
    Clock::duration waited_{}, waited_before_{};  // by now, by its beginning
    Clock::duration coder_{};                     // in it
    double bytes_ = 0, before_ = 0;               // in it; a second, before the trial
    Time next_trial_{};
    std::chrono::seconds pause_ = kFirstPause;
};

}  // namespace wall::client
