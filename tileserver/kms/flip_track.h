// SPDX-License-Identifier: MIT
// Where the pictures of a card's screens are on their way to the monitors. Pure: time is a parameter. One thread.
//
//            take()               sent()                arrived()
//    idle ───────────► waiting ───────────► in flight ───────────► idle
//     ▲                   │  EBUSY: it waits on   │
//     └───────────────────┴─────── drop() ────────┘     the monitor is gone: all of the screen's pictures are free
//
// Pictures of one moment go in one commit, so that monitors that beat together show them together. While one is in
// flight none is sent: the kernel has room for one commit of each CRTC.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tileserver/kms/card.h"

namespace wall::tileserver {

class FlipTrack {
public:
    using Clock = std::chrono::steady_clock;
    using Group = std::vector<std::size_t>;  ///< screens whose pictures go in one commit

    explicit FlipTrack(std::size_t screens) : screens_(screens) {}

    /// A picture was drawn for an idle screen.
    void take(std::size_t screen, FramebufferId picture);
    /// What is to be committed now, one after the other.
    std::vector<Group> due() const;
    /// The picture that waits; none: the screen's is not waiting.
    std::optional<FramebufferId> waiting(std::size_t screen) const;
    /// The kernel has taken their pictures.
    void sent(const Group& group, Clock::time_point now);
    /// The monitor shows the picture that was in flight. The one before, which is free now; none: there was none, or
    /// none was in flight.
    std::optional<FramebufferId> arrived(std::size_t screen);
    /// The monitor shows nothing any more.
    void drop(std::size_t screen) { screens_[screen] = {}; }
    /// The driver does not take several screens in one commit.
    void go_apart() { together_ = false; }
    bool together() const { return together_; }

    /// Pictures are waiting or in flight.
    bool busy() const;
    bool in_flight() const;
    /// How long the one that was sent first has been in flight.
    Clock::duration longest_flight(Clock::time_point now) const;

private:
    struct Screen {
        std::optional<FramebufferId> shown, waiting, in_flight;
        Clock::time_point sent{};
    };
    std::vector<Screen> screens_;
    bool together_ = true;
};

}  // namespace wall::tileserver
