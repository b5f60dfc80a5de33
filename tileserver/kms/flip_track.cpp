// SPDX-License-Identifier: MIT
#include "tileserver/kms/flip_track.h"

#include <algorithm>
#include <utility>

#include "common/base/assert.h"

namespace wall::tileserver {

void FlipTrack::take(std::size_t screen, FramebufferId picture) {
    Screen& at = screens_[screen];
    WALL_ASSERT(!at.waiting && !at.in_flight);
    at.waiting = picture;
}

std::vector<FlipTrack::Group> FlipTrack::due() const {
    std::vector<Group> out;
    if (in_flight()) return out;
    for (std::size_t i = 0; i < screens_.size(); ++i) {
        if (!screens_[i].waiting) continue;
        if (out.empty() || !together_) out.emplace_back();
        out.back().push_back(i);
    }
    return out;
}

std::optional<FramebufferId> FlipTrack::waiting(std::size_t screen) const { return screens_[screen].waiting; }

void FlipTrack::sent(const Group& group, Clock::time_point now) {
    for (const std::size_t screen : group) {
        Screen& at = screens_[screen];
        at.in_flight = std::exchange(at.waiting, std::nullopt);
        at.sent = now;
    }
}

std::optional<FramebufferId> FlipTrack::arrived(std::size_t screen) {
    Screen& at = screens_[screen];
    if (!at.in_flight) return {};
    return std::exchange(at.shown, std::exchange(at.in_flight, std::nullopt));
}

bool FlipTrack::busy() const {
    return std::ranges::any_of(screens_, [](const Screen& screen) { return screen.waiting || screen.in_flight; });
}

bool FlipTrack::in_flight() const {
    return std::ranges::any_of(screens_, [](const Screen& screen) { return screen.in_flight.has_value(); });
}

FlipTrack::Clock::duration FlipTrack::longest_flight(Clock::time_point now) const {
    Clock::duration out{};
    for (const Screen& screen : screens_)
        if (screen.in_flight) out = std::max(out, now - screen.sent);
    return out;
}

}  // namespace wall::tileserver
