// SPDX-License-Identifier: MIT
// What a node's tiles are shown on: windows of an X server (tile_windows.h), or monitors without a window system
// (tileserver/kms/kms_screens.h). Render thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"

namespace wall::tileserver {

/// One of them.
class TileScreen {
public:
    TileScreen(std::uint32_t slot, std::string tile) : slot_(slot), tile_(std::move(tile)) {}
    TileScreen(const TileScreen&) = delete;
    TileScreen& operator=(const TileScreen&) = delete;

    std::uint32_t slot() const { return slot_; }
    /// The tile's name.
    const std::string& tile() const { return tile_; }
    /// Pixels; 0: nothing can be shown there now.
    std::int32_t width() const { return width_; }
    std::int32_t height() const { return height_; }
    /// Its content is lost, in whole or in part, or its size is another since drawn().
    bool exposed() const { return exposed_; }
    void drawn() { exposed_ = false; }

protected:
    ~TileScreen() = default;
    void expose() { exposed_ = true; }
    void resize(std::int32_t width, std::int32_t height) {
        width_ = width;
        height_ = height;
        exposed_ = true;
    }

private:
    const std::uint32_t slot_;
    const std::string tile_;
    std::int32_t width_ = 0, height_ = 0;
    bool exposed_ = true;
};

/// A monitor shows a tile from now on, or nothing.
struct MonitorNews {
    std::string tile, connector;
    std::string monitor;  ///< what it calls itself
    std::string mode;     ///< that it shows the tile in; empty: it shows nothing
    std::string note;     ///< why, or what is special about it
};

class TileScreens {
public:
    virtual ~TileScreens() = default;
    TileScreens() = default;
    TileScreens(const TileScreens&) = delete;
    TileScreens& operator=(const TileScreens&) = delete;

    virtual std::size_t count() const = 0;
    virtual TileScreen& at(std::size_t i) const = 0;
    /// Between two pictures of the fastest monitor.
    virtual std::chrono::nanoseconds refresh_period() const = 0;
    /// Hears what has happened to the screens, without waiting. An error: nothing can be shown any more.
    virtual Result<void> take_events() = 0;
    /// Pictures are on their way to monitors: none is taken before they are there, which take_events() hears.
    virtual bool busy() const { return false; }
    /// Makes a screen the context's default framebuffer, and afterwards takes what was drawn there.
    virtual Result<void> select(std::size_t i) = 0;
    virtual Result<void> swap(std::size_t i) = 0;
    /// After the screens of one moment: what was taken and is not in sight yet is shown together.
    virtual Result<void> show() { return {}; }
    /// Since the last call.
    virtual std::vector<MonitorNews> take_news() { return {}; }
};

}  // namespace wall::tileserver
