// SPDX-License-Identifier: MIT
// The windows of a node's tiles as surfaces of its EGL context. One of them is always current, and stays so while
// layers are drawn: these are framebuffer objects, to which it makes no difference. Render thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "tileserver/gpu/tile_screens.h"
#include "tileserver/gpu/tile_window.h"
#include "tileserver/gpu/x11_display.h"

namespace wall::tileserver {

struct WindowRequest {
    std::string display;           ///< as in DISPLAY; empty: what DISPLAY says
    std::uint32_t background = 0;  ///< 0xRRGGBB, until a tile is drawn
    std::vector<WindowSpec> windows;
};

/// EGL's handles, without its header.
struct EglHandles {
    void* display = nullptr;
    void* config = nullptr;  ///< of the windows' surfaces
    void* context = nullptr;
};

class TileWindows final : public TileScreens {
public:
    /// Opens them all; the first is current then. `display` outlives it; `look.background` is the request's.
    static Result<std::unique_ptr<TileWindows>> open(const X11Display& display, const EglHandles& egl,
                                                     const WindowRequest& request, const WindowLook& look);
    ~TileWindows() override;

    std::size_t count() const override { return windows_.size(); }
    TileWindow& at(std::size_t i) const override { return *windows_[i].window; }
    std::chrono::nanoseconds refresh_period() const override { return refresh_period_; }

    /// Takes what the X server has sent. An error: the server or a window is gone.
    Result<void> take_events() override;
    Result<void> select(std::size_t i) override;
    /// Shows it as well.
    Result<void> swap(std::size_t i) override;

private:
    struct Entry {
        std::unique_ptr<TileWindow> window;
        void* surface = nullptr;  // EGL's
    };
    TileWindows(const X11Display& display, const EglHandles& egl)
        : display_(display), egl_(egl), refresh_period_(display.refresh_period()) {}
    Result<void> add(const WindowSpec& spec, const WindowLook& look);
    Result<void> failed(std::size_t i, const char* call) const;

    const X11Display& display_;
    const EglHandles egl_;
    std::chrono::nanoseconds refresh_period_;
    std::vector<Entry> windows_;
    std::size_t current_ = ~std::size_t{};  // index; beyond the end: none
};

}  // namespace wall::tileserver
