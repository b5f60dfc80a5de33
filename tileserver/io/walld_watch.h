// SPDX-License-Identifier: MIT
// Whether walld answers. A node asks it (Ping) when it has said nothing for half the swap limit; if nothing comes for
// the whole limit then, walld is silent, and the node shows frames by itself until it says something again. The limit
// is so paid once, not for each frame. Counts ticks rather than time: a node that stood still itself has missed
// nothing. Pure. I/O thread.
//
//   answers --no message for `silent_ticks_`--> silent --none for kLostLimit--> lost (the link is made anew)
//      ^------------- any message --------------'
#pragma once

#include <algorithm>
#include <chrono>
#include <utility>

namespace wall::tileserver {

class WalldWatch {
public:
    using Milliseconds = std::chrono::milliseconds;
    static constexpr Milliseconds kLongestInterval{500};
    static constexpr Milliseconds kLostLimit{15'000};  ///< a link on which nothing came for so long is no link
    enum class Need { nothing, ask, show_frames, new_link };

    explicit WalldWatch(Milliseconds swap_limit)
        : interval_(std::clamp(swap_limit / 2, Milliseconds(5), kLongestInterval)),
          silent_ticks_(static_cast<unsigned>(std::max(swap_limit / interval_, Milliseconds::rep{2})) + 1) {}

    /// Between two ticks.
    Milliseconds interval() const { return interval_; }
    /// There is a new link.
    void linked() {
        quiet_ = 0;
        silent_ = false;
    }
    /// A message has come. True: walld was silent before.
    bool heard() {
        quiet_ = 0;
        return std::exchange(silent_, false);
    }
    Need tick() {
        ++quiet_;
        if (quiet_ * interval_ >= kLostLimit) return Need::new_link;
        if (quiet_ == silent_ticks_) {
            silent_ = true;
            return Need::show_frames;
        }
        return quiet_ == 1 ? Need::ask : Need::nothing;
    }
    bool silent() const { return silent_; }

private:
    Milliseconds interval_;
    unsigned silent_ticks_;  ///< the first is the one that asks
    unsigned quiet_ = 0;     ///< ticks since the last message
    bool silent_ = false;
};

}  // namespace wall::tileserver
