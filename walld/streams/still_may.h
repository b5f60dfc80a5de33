// SPDX-License-Identifier: MIT
// Whether somebody who watches for long still may: tokens are revoked, people sign out, roles change. Pure; one thread.
#pragma once

#include <chrono>
#include <functional>
#include <utility>

#include "walld/wall/refusal.h"

namespace wall::walld {

class StillMay {
public:
    using Clock = std::chrono::steady_clock;
    using Ask = std::function<Outcome<void>()>;
    static constexpr std::chrono::seconds kEach{1};  ///< between two times that it is asked

    explicit StillMay(Ask ask) : ask_(std::move(ask)) {}

    /// Who may not any more never may again.
    const Outcome<void>& at(Clock::time_point now) {
        if (answer_ && now >= next_) {
            answer_ = ask_();
            next_ = now + kEach;
        }
        return answer_;
    }
    /// What was said last.
    const Outcome<void>& last() const { return answer_; }
    /// When to ask again, at the latest.
    Clock::time_point next() const { return next_; }

private:
    Ask ask_;
    Outcome<void> answer_;
    Clock::time_point next_{};
};

}  // namespace wall::walld
