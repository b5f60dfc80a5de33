// SPDX-License-Identifier: MIT
// How far apart the nodes of a swap group do the same thing: for each frame, the time from the first node to the last.
// Pure; times are parameters.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>

namespace wall::walld {

class Spread {
public:
    using Clock = std::chrono::steady_clock;
    using Milliseconds = std::chrono::duration<double, std::milli>;
    static constexpr double kMeanFrames = 16;  ///< about how many a mean follows
    /// Upper bounds of the histogram, which has one more for what is beyond.
    static constexpr std::array<double, 10> kBoundsMs{0.5, 1, 2, 4, 8, 16, 33, 66, 133, 250};
    using Histogram = std::array<std::uint64_t, kBoundsMs.size() + 1>;

    /// One node did it with `frame`. `group`: how many will.
    void note(std::uint32_t frame, std::size_t group, Clock::time_point now);

    std::uint64_t frames() const { return frames_; }  ///< measured so far
    Milliseconds last() const { return last_; }
    Milliseconds mean() const { return mean_; }  ///< of about the last kMeanFrames
    Milliseconds most() const { return most_; }
    Milliseconds sum() const { return sum_; }
    const Histogram& histogram() const { return histogram_; }  ///< frames by their time

private:
    struct Open {
        Clock::time_point first, last;
        std::size_t nodes = 0;
    };
    void finish(std::map<std::uint32_t, Open>::iterator frame);

    std::map<std::uint32_t, Open> open_;
    std::uint32_t given_up_ = 0;  ///< the last frame that was finished before all had done it: it does not begin again
    std::uint64_t frames_ = 0;
    Milliseconds last_{}, mean_{}, most_{}, sum_{};
    Histogram histogram_{};
};

}  // namespace wall::walld
