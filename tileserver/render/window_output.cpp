// SPDX-License-Identifier: MIT
#include "tileserver/render/window_output.h"

#include <algorithm>

namespace wall::tileserver {
namespace {

/// A little less than the monitor's period, so that the swap itself finds the beat. The thread would wait in a swap
/// that comes much too early, and all programs with it.
constexpr auto of_period(std::chrono::nanoseconds period) { return period * 7 / 8; }

}  // namespace

WindowOutput::WindowOutput(RenderNode& node, Compositor& compositor, TileWindows& windows,
                           std::function<void(const ScaledTile&)> scaled)
    : node_(node),
      compositor_(compositor),
      windows_(windows),
      scaled_(std::move(scaled)),
      interval_(of_period(windows.refresh_period())) {}

bool WindowOutput::any_wanted() const {
    for (std::size_t i = 0; i < windows_.count(); ++i)
        if (wanted(i)) return true;
    return false;
}

Result<void> WindowOutput::show(Clock::time_point now) {
    if (auto taken = windows_.take_events(); !taken) return taken;
    if (now < not_before_ || !any_wanted()) return {};
    for (std::size_t i = 0; i < windows_.count(); ++i)
        if (wanted(i))
            if (auto drawn = draw(i); !drawn) return drawn;
    shown_ = node_.damage;
    not_before_ = now + interval_;
    return {};
}

/// The tile's top row comes first, the window's bottom row. Mesa asks for a window's size once between two swaps, when
/// something is drawn while the window is bound: that is to be here, and not in somebody's work between.
Result<void> WindowOutput::draw(std::size_t i) {
    TileWindow& window = windows_.at(i);
    const auto picture = compositor_.output(window.spec().slot);
    window.drawn();
    if (!picture) return {};  // until walld has said which tiles there are, the X server shows the background
    tell_scaled(window, *picture);
    if (auto selected = windows_.select(i); !selected) return selected;
    node_.driver.disable_scissor();
    const Gl& gl = node_.driver.gl();
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    const bool as_it_is = window.width() == picture->width && window.height() == picture->height;
    gl.BlitNamedFramebuffer(picture->framebuffer, 0, 0, 0, picture->width, picture->height, 0, window.height(),
                            window.width(), 0, GL_COLOR_BUFFER_BIT, as_it_is ? GL_NEAREST : GL_LINEAR);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, picture->framebuffer);
    return windows_.swap(i);
}

void WindowOutput::tell_scaled(const TileWindow& window, const PictureTexture& picture) {
    if (window.width() == picture.width && window.height() == picture.height) return;
    if (told_.insert(window.spec().slot).second)
        scaled_({window.spec().tile, picture.width, picture.height, window.width(), window.height()});
}

WindowOutput::Clock::duration WindowOutput::next_due(Clock::time_point now) const {
    return any_wanted() ? std::max(Clock::duration{}, not_before_ - now) : Clock::duration::max();
}

}  // namespace wall::tileserver
