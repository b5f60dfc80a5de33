// SPDX-License-Identifier: MIT
#include "tools/wallview/viewer.h"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>

#include <cstdlib>
#include <ctime>
#include <iostream>

#include "tools/wallview/png.h"

namespace wall::wallview {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLook = 100;                             // ms without an event
constexpr std::chrono::milliseconds kSizeStands{300};  // that a new size must last before it is asked for

/// SDL's video, as long as this lives.
struct Video {
    ~Video() { SDL_Quit(); }
};

/// SDL has found only a driver that shows nothing, which nobody asked for.
bool unseen() {
    const std::string driver = SDL_GetCurrentVideoDriver();
    return std::getenv("SDL_VIDEODRIVER") == nullptr && (driver == "offscreen" || driver == "dummy");
}

/// What is watched in a window of that size: never more pixels than it shows.
nlohmann::json entry_for(const nlohmann::json& what, const Window::Size& size) {
    auto entry = what;
    entry.update({{"width", std::max(1, size.width)}, {"height", std::max(1, size.height)}, {"fit", true}});
    return entry;
}

class Viewer {
public:
    Viewer(const view::LiveView::Connect& connect, const Options& options, Window& window)
        : options_(options),
          window_(window),
          asked_(window.size()),
          live_(connect, entry_for(options.what, asked_), view::LiveView::AfterFailure::connect_again,
                [event = SDL_RegisterEvents(1)] {
                    SDL_Event news{};
                    news.type = event;
                    SDL_PushEvent(&news);
                }) {}

    Result<void> run() {
        while (!over_) {
            SDL_Event event;
            bool due = SDL_WaitEventTimeout(&event, kLook) != 0;
            for (; due; due = SDL_PollEvent(&event) != 0) handle(event);
            watch_new_size();
            if (auto shown = show(); !shown) return shown;
        }
        return options_.save.empty() ? Result<void>() : save(options_.save);
    }

private:
    void handle(const SDL_Event& event) {
        if (event.type == SDL_QUIT) over_ = true;
        if (event.type == SDL_KEYDOWN && event.key.repeat == 0) press(event.key.keysym.sym);
        if (event.type == SDL_MOUSEBUTTONDOWN && event.button.clicks == 2) window_.toggle_fullscreen();
        if (event.type == SDL_WINDOWEVENT) change(event.window.event);
    }
    void press(SDL_Keycode key) {
        if (key == SDLK_q || key == SDLK_ESCAPE) over_ = true;
        if (key == SDLK_f) window_.toggle_fullscreen();
        if (key == SDLK_s) save_now();
    }
    void change(Uint8 event) {
        if (event == SDL_WINDOWEVENT_MINIMIZED || event == SDL_WINDOWEVENT_HIDDEN) live_.pause(true);
        if (event == SDL_WINDOWEVENT_RESTORED || event == SDL_WINDOWEVENT_SHOWN || event == SDL_WINDOWEVENT_MAXIMIZED)
            live_.pause(false);
        if (event == SDL_WINDOWEVENT_SIZE_CHANGED) resized_ = Clock::now();
        draw_ = true;
    }
    void watch_new_size() {
        if (!resized_ || Clock::now() - *resized_ < kSizeStands) return;
        resized_.reset();
        asked_ = window_.size();
        live_.watch(entry_for(options_.what, asked_));
    }

    /// Complete pictures only, so that tiles change together as far as they came together; the first may be incomplete.
    Result<void> show() {
        Result<void> good;
        std::string failure, ended;
        live_.look([&](const view::Looked& now) {
            failure = now.failure;
            ended = now.builder.ended();
            const bool fresh = now.frames != frames_, complete = now.builder.complete();
            if (!fresh || !(complete || shown_ == 0)) return;
            frames_ = now.frames;
            shown_ += complete ? 1 : 0;
            good = window_.set_picture(now.builder.picture().view());
            draw_ = true;
        });
        if (!good) return good;
        if (options_.frames > 0 && shown_ == 0 && !failure.empty()) return fail(failure);
        say(failure.empty() ? ended : failure, failure.empty());
        if (std::exchange(draw_, false)) window_.draw();
        if (options_.frames > 0 && shown_ >= options_.frames) over_ = true;
        return {};
    }
    void say(const std::string& problem, bool connected) {
        if (problem == said_) return;
        said_ = problem;
        const auto note = problem.empty() ? ""
                          : connected     ? " (" + problem + ")"
                                          : " (connecting again: " + problem + ")";
        window_.set_title(options_.title + note);
        std::cerr << "wallview: " << (problem.empty() ? "connected" : problem) << '\n';
    }

    Result<void> save(const std::string& path) const {
        Result<void> done;
        live_.look([&](const view::Looked& now) { done = save_png(now.builder.picture().view(), path); });
        return done;
    }
    void save_now() {
        const auto path = fmt::format("wallview-{:%Y%m%d-%H%M%S}.png", fmt::localtime(std::time(nullptr)));
        const auto done = save(path);
        const auto said = done ? "saved " + path : done.error().message;
        window_.set_title(options_.title + " (" + said + ")");
        std::cerr << "wallview: " << said << '\n';
    }

    const Options& options_;
    Window& window_;
    Window::Size asked_;
    std::optional<Clock::time_point> resized_;
    std::uint64_t frames_ = 0, shown_ = 0;  ///< LiveView's count at the last picture; complete pictures
    std::string said_;
    bool draw_ = true, over_ = false;
    view::LiveView live_;
};

}  // namespace

Result<void> run(const view::LiveView::Connect& connect, const Options& options) {
    if (SDL_Init(SDL_INIT_VIDEO) != 0) return fail(std::string("no display: ") + SDL_GetError());
    const Video video;
    if (unseen()) return fail("no display: neither X nor Wayland nor a monitor (DISPLAY is not set?)");
    SDL_EnableScreenSaver();
    auto window = Window::open(options.title, options.size, options.fullscreen);
    if (!window) return tl::unexpected(window.error());
    return Viewer(connect, options, **window).run();
}

}  // namespace wall::wallview
