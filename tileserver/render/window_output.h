// SPDX-License-Identifier: MIT
// Shows tiles in their windows: composes and draws when something has changed or the X server has lost a picture, and
// at most once for each picture of the monitors. Render thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <set>
#include <string>

#include "tileserver/gpu/tile_windows.h"
#include "tileserver/render/compositor.h"

namespace wall::tileserver {

/// A tile that its window shows larger or smaller than it is, in pixels.
struct ScaledTile {
    std::string tile;
    std::int32_t width = 0, height = 0, window_width = 0, window_height = 0;
};

class WindowOutput {
public:
    using Clock = std::chrono::steady_clock;

    /// `scaled` hears of each tile once. All outlive it.
    WindowOutput(RenderNode& node, Compositor& compositor, TileWindows& windows,
                 std::function<void(const ScaledTile&)> scaled);

    /// What is due now. An error: nothing can be shown any more.
    Result<void> show(Clock::time_point now);
    /// How long until something is due if nothing changes but the time.
    Clock::duration next_due(Clock::time_point now) const;

private:
    bool wanted(std::size_t i) const { return shown_ != node_.damage || windows_.at(i).exposed(); }
    bool any_wanted() const;
    Result<void> draw(std::size_t i);
    void tell_scaled(const TileWindow& window, const PictureTexture& picture);

    RenderNode& node_;
    Compositor& compositor_;
    TileWindows& windows_;
    std::function<void(const ScaledTile&)> scaled_;
    std::set<std::uint32_t> told_;  // slots
    const Clock::duration interval_;
    std::uint64_t shown_ = 0;  // RenderNode::damage at the last picture
    Clock::time_point not_before_{};
};

}  // namespace wall::tileserver
