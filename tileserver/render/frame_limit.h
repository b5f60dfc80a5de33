// SPDX-License-Identifier: MIT
// No more frames a second of a window than a program may have: its stream pauses behind a frame that comes too early.
// The program waits for the nodes' frames, so it becomes as slow. Pure; the time is a parameter.
#pragma once

#include <algorithm>
#include <chrono>
#include <map>

#include "common/base/ids.h"

namespace wall::tileserver {

class FrameLimit {
public:
    using Clock = std::chrono::steady_clock;

    /// Zero: no limit.
    void set_interval(Clock::duration interval) {
        if (interval == interval_) return;
        interval_ = interval;
        due_.clear();
        pause_until_ = {};
    }
    /// A frame of the window has ended.
    void frame(SurfaceId window, Clock::time_point now) {
        if (interval_ <= Clock::duration::zero()) return;
        if (due_.size() >= kMostWindows) std::erase_if(due_, [&](const auto& entry) { return entry.second <= now; });
        auto& due = due_[window];
        pause_until_ = std::max(pause_until_, std::min(due, now + interval_));
        due = std::max(due, now) + interval_;
    }
    /// The stream goes on from then on.
    Clock::time_point pause_until() const { return pause_until_; }

private:
    static constexpr std::size_t kMostWindows = 512;  // that are kept in mind

    Clock::duration interval_{};
    std::map<SurfaceId, Clock::time_point> due_;  // the window's next frame
    Clock::time_point pause_until_{};
};

}  // namespace wall::tileserver
