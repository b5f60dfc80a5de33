// SPDX-License-Identifier: MIT
// What one process of a parallel program knows of where a window is drawn (docs/parallel-programs.md, "How the
// processes agree"). All processes take a placement at the same frame: walld proposes one from a frame on, each says
// whether it has begun that frame already, and begins it only when it knows what holds there. Pure; ControlLink's lock
// guards it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "client_lib/link/control_messages.h"

namespace wall::client {

class MemberPlacements {
public:
    /// It takes the place of an earlier proposal. Gives the frame that has begun and is too late for it; 0: it is in
    /// time.
    std::uint32_t propose(const Placement& placement) {
        proposed_.reset();
        if (placement.from_frame <= begun_) return begun_;
        proposed_ = placement;
        return 0;
    }
    /// What was proposed holds; nothing for one that another proposal has replaced.
    std::optional<Placement> agree(std::uint32_t version) {
        if (!proposed_ || proposed_->layout_version != version) return std::nullopt;
        Placement placement = *std::exchange(proposed_, std::nullopt);
        add(placement);
        return placement;
    }
    /// It holds without having been proposed here. False: that is known.
    bool add(const Placement& placement) {
        if (proposed_ && proposed_->layout_version == placement.layout_version) proposed_.reset();
        if (!agreed_.empty() && placement.layout_version <= agreed_.back().layout_version) return false;
        std::erase_if(agreed_, [&](const Placement& old) { return old.from_frame >= placement.from_frame; });
        agreed_.push_back(placement);
        return true;
    }

    /// What holds in that frame is known.
    bool known(std::uint32_t frame) const { return !proposed_ || frame < proposed_->from_frame; }
    /// Only a frame for which everything is known.
    void begin(std::uint32_t frame) {
        begun_ = std::max(begun_, frame);
        while (agreed_.size() > 1 && agreed_[1].from_frame <= begun_) agreed_.erase(agreed_.begin());
    }

    /// That which holds, and those that will, in order.
    const std::vector<Placement>& agreed() const { return agreed_; }

private:
    std::vector<Placement> agreed_;
    std::optional<Placement> proposed_;
    std::uint32_t begun_ = 0;
};

}  // namespace wall::client
