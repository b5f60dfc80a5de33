// SPDX-License-Identifier: MIT
// Shows tiles on their screens, which are windows or monitors: composes and draws when something has changed or a
// screen has lost its picture, and at most once for each picture of the monitors. Render thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <set>
#include <string>

#include "tileserver/gpu/tile_screens.h"
#include "tileserver/render/compositor.h"

namespace wall::tileserver {

/// A tile that its screen shows larger or smaller than it is, in pixels.
struct ScaledTile {
    std::string tile;
    std::int32_t width = 0, height = 0, screen_width = 0, screen_height = 0;
};

class ScreenOutput {
public:
    using Clock = std::chrono::steady_clock;
    struct Events {
        std::function<void(const ScaledTile&)> scaled;  ///< hears of each tile once
        std::function<void(const MonitorNews&)> monitor;
    };

    /// `node`, `compositor` and `screens` outlive it.
    ScreenOutput(RenderNode& node, Compositor& compositor, TileScreens& screens, Events events)
        : node_(node), compositor_(compositor), screens_(screens), events_(std::move(events)) {}

    /// What is due now. An error: nothing can be shown any more.
    Result<void> show(Clock::time_point now);
    /// How long until something is due if nothing changes but the time.
    Clock::duration next_due(Clock::time_point now) const;

private:
    bool wanted(std::size_t i) const;
    bool any_wanted() const;
    Result<void> draw(std::size_t i);
    void tell_scaled(const TileScreen& screen, const PictureTexture& picture);

    RenderNode& node_;
    Compositor& compositor_;
    TileScreens& screens_;
    const Events events_;
    std::set<std::uint32_t> told_;  // slots
    std::uint64_t shown_ = 0;       // RenderNode::damage at the last picture
    Clock::time_point not_before_{};
};

}  // namespace wall::tileserver
