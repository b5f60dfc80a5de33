// SPDX-License-Identifier: MIT
#include "tileserver/render/screen_output.h"

#include <algorithm>

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

/// A little less than the monitor's period, so that the swap itself finds the beat. The thread would wait in a swap
/// that comes much too early, and all programs with it.
constexpr auto of_period(std::chrono::nanoseconds period) { return period * 7 / 8; }

/// Between two looks whether a picture has reached its monitor.
constexpr auto kBusyPoll = 1ms;

}  // namespace

bool ScreenOutput::wanted(std::size_t i) const {
    const TileScreen& screen = screens_.at(i);
    return screen.width() != 0 && (shown_ != node_.damage || screen.exposed());
}

bool ScreenOutput::any_wanted() const {
    for (std::size_t i = 0; i < screens_.count(); ++i)
        if (wanted(i)) return true;
    return false;
}

Result<void> ScreenOutput::show(Clock::time_point now) {
    auto taken = screens_.take_events();
    for (const MonitorNews& news : screens_.take_news()) events_.monitor(news);
    if (!taken) return taken;
    if (screens_.busy() || now < not_before_ || !any_wanted()) return {};
    for (std::size_t i = 0; i < screens_.count(); ++i)
        if (wanted(i))
            if (auto drawn = draw(i); !drawn) return drawn;
    shown_ = node_.damage;
    not_before_ = now + of_period(screens_.refresh_period());
    return screens_.show();
}

/// The tile's top row comes first, the screen's bottom row. Mesa asks for a window's size once between two swaps, when
/// something is drawn while the window is bound: that is to be here, and not in somebody's work between.
Result<void> ScreenOutput::draw(std::size_t i) {
    TileScreen& screen = screens_.at(i);
    const auto picture = compositor_.output(screen.slot());
    screen.drawn();
    if (!picture) return {};  // until walld has said which tiles there are, the screen shows the background
    tell_scaled(screen, *picture);
    if (auto selected = screens_.select(i); !selected) return selected;
    node_.driver.disable_scissor();
    const Gl& gl = node_.driver.gl();
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    const bool as_it_is = screen.width() == picture->width && screen.height() == picture->height;
    gl.BlitNamedFramebuffer(picture->framebuffer, 0, 0, 0, picture->width, picture->height, 0, screen.height(),
                            screen.width(), 0, GL_COLOR_BUFFER_BIT, as_it_is ? GL_NEAREST : GL_LINEAR);
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, picture->framebuffer);
    return screens_.swap(i);
}

void ScreenOutput::tell_scaled(const TileScreen& screen, const PictureTexture& picture) {
    if (screen.width() == picture.width && screen.height() == picture.height) return;
    if (told_.insert(screen.slot()).second)
        events_.scaled({screen.tile(), picture.width, picture.height, screen.width(), screen.height()});
}

ScreenOutput::Clock::duration ScreenOutput::next_due(Clock::time_point now) const {
    if (!screens_.busy() && !any_wanted()) return Clock::duration::max();
    const auto least = screens_.busy() ? Clock::duration(kBusyPoll) : Clock::duration{};
    return std::max(least, not_before_ - now);
}

}  // namespace wall::tileserver
