// SPDX-License-Identifier: MIT
// Whether vertices that lie a little off make a stream smaller. Mostly they do; but where a coder finds the same
// numbers again and again, a grid that changes with the distance has fewer of them. So it is tried
// (process/measured_choice.h), with what has gone over the links in place of the time: judged is how much was packed
// for each byte of that. Pure.
#pragma once

#include <chrono>
#include <cstdint>
#include <utility>

#include "client_lib/process/measured_choice.h"

namespace wall::client {

class SmallerChoice {
public:
    /// Vertices are to lie off.
    bool moves() const { return choice_.other(); }

    /// A frame is over. `packed`, `sent`: bytes so far, before coding and on the links.
    void note_frame(std::uint64_t packed, std::uint64_t sent) {
        const auto more = static_cast<double>(packed - std::exchange(packed_, packed));
        if (waits_ > 0) {
            --waits_;
            return;
        }
        const bool before = moves();
        choice_.done(
            more, before, MeasuredChoice::Time(std::chrono::microseconds(sent)),
            [](double) { return MeasuredChoice::Seen{.usual_in_doubt = true, .other_in_doubt = true}; }, [] {});
        if (moves() != before) waits_ = kOnTheirWay;
    }

private:
    static constexpr double kBetter = 1.03;      ///< less would not be worth the loss
    static constexpr double kLeastPacked = 4e6;  ///< bytes that say something
    static constexpr int kOnTheirWay = 4;        ///< frames that may be packed and not yet sent

    MeasuredChoice choice_{{.better = kBetter, .least = kLeastPacked}};
    std::uint64_t packed_ = 0;
    int waits_ = 0;
};

}  // namespace wall::client
