// SPDX-License-Identifier: MIT
// Whether what goes to a node is coded (common/wire/history_coder.h). That pays where the link is what a program waits
// for; where it is the node, or nothing, it only costs. What it is nobody can see from here: between them stand
// sockets, an agent, encryption. So where a program waits for a node it is tried, and judged by what the node has got
// in a while (process/measured_choice.h), counted as it was packed: coded must be 1.2 times as much as plain was, or it
// be waited for no longer. Pure; the time is an argument.
#pragma once

#include <chrono>
#include <cstddef>

#include "client_lib/process/measured_choice.h"
#include "client_lib/process/options.h"

namespace wall::client {

class CodingChoice {
public:
    using Clock = MeasuredChoice::Clock;
    using Time = MeasuredChoice::Time;

    static constexpr double kLimit = 0.5;  ///< share of a while that was waited: the link may be slow
    static constexpr double kBusy = 0.8;   ///< share of it that went to coding: that may be slow

    explicit CodingChoice(Coding coding) : coding_(coding) {}

    bool codes() const { return coding_ == Coding::measured ? choice_.other() : coding_ == Coding::always; }

    void coding_took(Clock::duration time) { coder_ += time; }

    /// The node has got a batch of so many bytes, as they were before coding. `waited`: how long it was waited for so
    /// far, since the stream's beginning.
    void delivered(std::size_t bytes, bool coded, Time now, Clock::duration waited) {
        if (coding_ != Coding::measured) return;
        choice_.done(
            static_cast<double>(bytes), coded, now,
            [&](double seconds) {
                const auto share = [&](Clock::duration of) {
                    return std::chrono::duration<double>(of).count() / seconds;
                };
                const bool waits = share(waited - waited_before_) > kLimit;
                return MeasuredChoice::Seen{waits, share(coder_) > kBusy, !waits};
            },
            [&] {
                waited_before_ = waited;
                coder_ = {};
            });
    }

private:
    const Coding coding_;
    MeasuredChoice choice_{{.better = 1.2, .least = 0}};
    Clock::duration waited_before_{};  // by the beginning of the while
    Clock::duration coder_{};          // in it
};

}  // namespace wall::client
