// SPDX-License-Identifier: MIT
// A choice between two ways of doing the same, by what is measured: the usual one, and another one that pays only
// sometimes. What decides it is how much gets done in a while. Where there is reason to doubt the present way the other
// one is tried for as long, and kept if it does so much better. What did not pay is tried again later, ever more
// rarely; at once where much less gets done than did then, since that says nothing any more. So what a wrong guess
// costs is bounded, and nothing swings to and fro. Pure; the time is an argument.
#pragma once

#include <algorithm>
#include <chrono>
#include <optional>

namespace wall::client {

class MeasuredChoice {
public:
    using Clock = std::chrono::steady_clock;
    using Time = Clock::time_point;

    static constexpr std::chrono::milliseconds kWindow{500};  ///< that is measured at least
    static constexpr double kMuchLess = 0.5;                  ///< than at the last trial
    static constexpr std::chrono::seconds kFirstPause{10}, kLongestPause{300};

    /// How much better the other way must be, and how much must be done in a while that says something.
    struct Bars {
        double better = 1.2;
        double least = 0;
    };
    explicit MeasuredChoice(const Bars& bars) : bars_(bars) {}

    /// The other way.
    bool other() const { return state_ == State::other || state_ == State::other_on_trial; }
    bool on_trial() const { return state_ == State::other_on_trial || state_ == State::usual_on_trial; }

    /// What has been seen in a while.
    struct Seen {
        bool usual_in_doubt = false, other_in_doubt = false;  ///< the present way may not be the better one
        bool enough = false;  ///< the other way, on trial, leaves nothing to be wished for
    };
    /// So much was done, in the way of `other`. Where a while is over, `look(seconds)` says what was seen in it; it
    /// began at the last call of `begun()`.
    template <class Look, class Begun>
    void done(double amount, bool other, Time now, Look&& look, Begun&& begun) {
        if (other != this->other()) return;  // of before the last change: it was on its way
        if (!begin_) {
            start(now);
            return begun();
        }
        amount_ += amount;
        const double seconds = std::chrono::duration<double>(now - *begin_).count();
        if (now - *begin_ < kWindow || amount_ < bars_.least) return;
        judge(amount_ / seconds, look(seconds), now);
        if (begin_) begun();
    }

private:
    enum class State { usual, other_on_trial, other, usual_on_trial };

    void start(Time now) {
        begin_ = now;
        amount_ = 0;
    }
    void go(State state, Time now) {
        state_ = state;
        if (on_trial()) begin_.reset();  // until something is done so
        else start(now);
    }
    void judge(double rate, const Seen& seen, Time now) {
        switch (state_) {
            case State::usual:
            case State::other: {
                const bool doubt = state_ == State::usual ? seen.usual_in_doubt : seen.other_in_doubt;
                const bool much_less = state_ == State::usual && rate < kMuchLess * before_;
                if (!doubt || (now < next_trial_ && !much_less)) return start(now);
                if (much_less) pause_ = kFirstPause;
                before_ = rate;
                return go(state_ == State::usual ? State::other_on_trial : State::usual_on_trial, now);
            }
            case State::other_on_trial:
                return settle(seen.enough || rate > bars_.better * before_, State::other, State::usual, now);
            case State::usual_on_trial: return settle(rate > bars_.better * before_, State::usual, State::other, now);
        }
    }
    void settle(bool better, State next, State back, Time now) {
        next_trial_ = now + pause_;
        pause_ = better ? kFirstPause : std::min(2 * pause_, kLongestPause);
        go(better ? next : back, now);
    }

    const Bars bars_;
    State state_ = State::usual;
    std::optional<Time> begin_;       // of the while
    double amount_ = 0, before_ = 0;  // done in it; a second, before the trial
    Time next_trial_{};
    std::chrono::seconds pause_ = kFirstPause;
};

}  // namespace wall::client
