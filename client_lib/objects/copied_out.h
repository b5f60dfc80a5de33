// SPDX-License-Identifier: MIT
// Whether a framebuffer object is drawn anew and copied as it is to the same place, frame after frame. Pure.
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/base/ids.h"

namespace wall::client {

class CopiedOut {
public:
    static constexpr unsigned kFrames = 8;         ///< in a row that make a habit
    static constexpr unsigned kMostFrames = 4096;  ///< the same after it has been broken, each time eight times more

    struct Place {
        ClientName object;          ///< that it is copied to; 0: it is a window
        SurfaceId window;           ///< or this
        std::int32_t x = 0, y = 0;  ///< where its first pixel comes
        bool operator==(const Place&) const = default;
    };

    /// Its colours or depths were cleared, or something was copied over all of it.
    void note_redrawn() { redrawn_ = true; }
    /// The frame in which it was copied last.
    std::uint32_t frame() const { return frame_; }
    /// In the frame of that number all of it was copied there as it is: a window's, or that in which the other object
    /// was copied last. Whether it is a habit.
    bool note(std::uint32_t frame, const Place& to) {
        const bool anew = redrawn_;
        redrawn_ = false;
        if (frame == frame_ && to == to_ && count_ > 0) return is_habit();
        const bool goes_on = anew && to == to_ && frame == frame_ + 1;
        count_ = goes_on ? std::min(count_ + 1, kMostFrames) : anew ? 1 : 0;
        frame_ = frame;
        to_ = to;
        return is_habit();
    }
    /// Whether that goes on with a copy there in that frame.
    bool goes_on(std::uint32_t frame, const Place& to) const {
        return to == to_ && (frame == frame_ ? count_ > 0 : redrawn_ && frame == frame_ + 1);
    }
    bool is_habit() const { return count_ >= needed_; }
    /// Somebody needed it otherwise, after all.
    void note_broken() {
        count_ = 0;
        needed_ = std::min(8 * needed_, kMostFrames);
    }

private:
    bool redrawn_ = false;     // since it was copied
    std::uint32_t frame_ = 0;  // of the last copy
    Place to_;
    unsigned count_ = 0;  // frames in a row
    unsigned needed_ = kFrames;
};

}  // namespace wall::client
