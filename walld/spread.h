// SPDX-License-Identifier: MIT
// How far apart the nodes of a swap group do the same thing: for each frame, the time from the first node to the last.
// Pure; times are parameters.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>

namespace wall::walld {

class Spread {
public:
    using Clock = std::chrono::steady_clock;
    using Milliseconds = std::chrono::duration<double, std::milli>;

    /// One node did it with `frame`. `group`: how many will.
    void note(std::uint32_t frame, std::size_t group, Clock::time_point now);

    std::uint64_t frames() const { return frames_; }  ///< measured so far
    Milliseconds last() const { return last_; }
    Milliseconds mean() const { return mean_; }       ///< of about the last 16 frames
    Milliseconds most() const { return most_; }

private:
    struct Open {
        Clock::time_point first, last;
        std::size_t nodes = 0;
    };
    void finish(std::map<std::uint32_t, Open>::iterator frame);

    std::map<std::uint32_t, Open> open_;
    std::uint64_t frames_ = 0;
    Milliseconds last_{}, mean_{}, most_{};
};

}  // namespace wall::walld
