// SPDX-License-Identifier: MIT
#include "walld/wall/placement_track.h"

namespace wall::walld {
namespace {

constexpr std::size_t kMaxOffered = 64;  // a program that does not draw adopts none; only the newest ones matter
constexpr std::size_t kMaxAdopted = 8;   // a program is at most two frames ahead

}  // namespace

void PlacementTrack::want(const geom::Rect& rect) {
    wanted_ = rect;
    offered_[++version_] = rect;
    if (offered_.size() > kMaxOffered) offered_.erase(offered_.begin());
}

bool PlacementTrack::adopt(std::uint32_t version, std::uint32_t frame) {
    const auto found = offered_.find(version);
    if (found == offered_.end()) return false;
    drawn_ = found->second;
    offered_.erase(offered_.begin(), std::next(found));
    adopted_.push_back({frame, drawn_});
    if (adopted_.size() > kMaxAdopted) adopted_.pop_front();
    return true;
}

bool PlacementTrack::presented(std::uint32_t frame) {
    const auto before = shown_;
    while (!adopted_.empty() && adopted_.front().frame <= frame) {
        shown_ = adopted_.front().rect;
        adopted_.pop_front();
    }
    return shown_ != before;
}

}  // namespace wall::walld
