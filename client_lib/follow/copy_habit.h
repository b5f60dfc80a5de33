// SPDX-License-Identifier: MIT
// Whether a program copies out of a window frame after frame. If so, nodes may copy by themselves: what is lost with a
// node comes again. Where many copies are made in each frame, it pays that every node draws the whole window: else each
// copy waits for what is gathered from all of them. Pure.
#pragma once

#include <cstdint>

namespace wall::client {

class CopyHabit {
public:
    static constexpr unsigned kFrames = 3;  ///< in a row that make a habit
    static constexpr unsigned kMany = 8;    ///< copies in a frame

    /// A copy in the frame of that number.
    void note(std::uint32_t frame) {
        if (frame != frame_) {
            const bool next = frame == frame_ + 1;
            any_ = next && count_ > 0 ? any_ + 1 : 0;
            many_ = next && count_ >= kMany ? many_ + 1 : 0;
            frame_ = frame;
            count_ = 0;
        }
        ++count_;
    }
    /// In the frames just before there were copies, or many.
    bool copies() const { return any_ >= kFrames; }
    bool copies_much() const { return many_ >= kFrames; }

private:
    std::uint32_t frame_ = 0;
    unsigned count_ = 0;           // in that frame
    unsigned any_ = 0, many_ = 0;  // frames just before it, in a row, with so many
};

}  // namespace wall::client
