// SPDX-License-Identifier: MIT
// One window of the X server, without decorations and without a cursor, that a tile is drawn in. It works with and
// without a window manager. Render thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/geom/rect.h"
#include "tileserver/gpu/tile_screens.h"
#include "tileserver/gpu/x11_display.h"

union _XEvent;

namespace wall::tileserver {

/// What wall.toml says of a tile in a window.
struct WindowSpec {
    std::uint32_t slot = 0;  ///< of the tile
    std::string tile;        ///< its name
    std::string monitor;     ///< that the window covers; empty: it covers `rect`
    geom::Rect rect;         ///< pixels of the X screen; with a monitor only the tile's size counts
    /// The window that it lies in, which belongs to another program, and gets all that is typed and clicked there; 0:
    /// none, and `rect` is in that window's pixels otherwise.
    unsigned long parent = 0;
};

/// What it is made with. Pixels of 8 bits a channel without alpha, so that they are shown as they are.
struct WindowLook {
    unsigned long visual = 0;      ///< its id, of depth kWindowDepth
    std::uint32_t background = 0;  ///< 0xRRGGBB, until the tile is drawn
};
inline constexpr int kWindowDepth = 24;  ///< bits a pixel

class TileWindow final : public TileScreen {
public:
    /// Mapped, not waited for. `display` outlives it.
    static Result<std::unique_ptr<TileWindow>> open(const X11Display& display, const WindowSpec& spec,
                                                    const WindowLook& look);
    ~TileWindow();

    unsigned long id() const { return window_; }
    /// One of its events.
    void take(const _XEvent& event);
    /// Somebody has destroyed it.
    bool gone() const { return gone_; }

private:
    TileWindow(const X11Display& display, const WindowSpec& spec)
        : TileScreen(spec.slot, spec.tile), display_(display), spec_(spec) {}
    Result<void> create(const geom::Rect& place, const WindowLook& look);
    void tell_window_manager(const geom::Rect& place) const;

    const X11Display& display_;
    const WindowSpec spec_;
    unsigned long window_ = 0, colormap_ = 0, cursor_ = 0;  // of X; 0: none
    bool gone_ = false;
};

}  // namespace wall::tileserver
