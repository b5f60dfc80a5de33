// SPDX-License-Identifier: MIT
// When a node whose stream broke, or could not be opened, is tried again. A node that is merely away is asked for ever,
// ever more rarely. One that has ended the program's stream for a cause would end it again: after a few times it is
// left alone until walld tells of another process of it. Pure; the time is an argument.
#pragma once

#include <algorithm>
#include <chrono>

namespace wall::client {

class Reopening {
public:
    using Time = std::chrono::steady_clock::time_point;
    using Seconds = std::chrono::seconds;

    static constexpr Seconds kPause{1};         ///< before the second attempt
    static constexpr unsigned kEvenPauses = 2;  ///< so many are of that length, each later one twice as long
    static constexpr Seconds kLongestPause{30};
    static constexpr Seconds kProven{30};  ///< a stream that lasted so long has made up for what was before
    static constexpr unsigned kMostEndings = 3;

    void opened(Time now) { opened_ = now; }
    void not_opened(Time now) { pause(now); }
    /// A stream that was open has failed; `ended`: the node has said why it ends it.
    void lost(Time now, bool ended) {
        if (now - opened_ >= kProven) failures_ = endings_ = 0;
        if (ended) ++endings_;
        if (failures_ == 0 && !ended) {
            ++failures_;  // at once, for the first time
            next_ = now;
        } else {
            pause(now);
        }
    }
    bool given_up() const { return endings_ >= kMostEndings; }
    /// Whether it is time for an attempt.
    bool due(Time now) const { return !given_up() && now >= next_; }

private:
    void pause(Time now) {
        const unsigned doublings = failures_ < kEvenPauses ? 0 : std::min(failures_ - kEvenPauses + 1, 8u);
        next_ = now + std::min(kPause * (1 << doublings), kLongestPause);
        ++failures_;
    }

    unsigned failures_ = 0, endings_ = 0;
    Time opened_, next_;
};

}  // namespace wall::client
