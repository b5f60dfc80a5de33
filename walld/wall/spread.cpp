// SPDX-License-Identifier: MIT
#include "walld/wall/spread.h"

#include <algorithm>

namespace wall::walld {
namespace {

constexpr std::size_t kMaxOpen = 8;  // a node that is later than this many frames is not waited for here either

}  // namespace

void Spread::note(std::uint32_t frame, std::size_t group, Clock::time_point now) {
    if (frame <= given_up_ && !open_.contains(frame)) return;
    const auto at = open_.try_emplace(frame, Open{.first = now, .last = now}).first;
    at->second.last = now;
    if (++at->second.nodes >= group) return finish(at);
    if (open_.size() <= kMaxOpen) return;
    given_up_ = std::max(given_up_, open_.begin()->first);
    finish(open_.begin());
}

void Spread::finish(std::map<std::uint32_t, Open>::iterator frame) {
    last_ = frame->second.last - frame->second.first;
    open_.erase(frame);
    ++frames_;
    mean_ += (last_ - mean_) / std::min<double>(static_cast<double>(frames_), kMeanFrames);
    most_ = std::max(most_, last_);
    sum_ += last_;
    ++histogram_[static_cast<std::size_t>(std::ranges::lower_bound(kBoundsMs, last_.count()) - kBoundsMs.begin())];
}

}  // namespace wall::walld
