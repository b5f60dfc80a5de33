// SPDX-License-Identifier: MIT
#include "tools/wallview/window.h"

#include <algorithm>

#include "tools/wallview/geometry.h"
#include "tools/wallview/window_manager.h"

namespace wall::wallview {
namespace {

tl::unexpected<Error> failed(const char* what) { return fail(std::string(what) + ": " + SDL_GetError()); }

}  // namespace

Result<std::unique_ptr<Window>> Window::open(const std::string& title, const Size& size, bool fullscreen) {
    std::unique_ptr<Window> out(new Window);
    SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "linear");
    // SDL's software renderer would else go through OpenGL to the screen, and be drawn shifted after a change of size
    // (2.26).
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    const Uint32 flags = SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI;
    out->window_.reset(SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, size.width,
                                        size.height, flags));
    if (!out->window_) return failed("no window");
    out->renderer_.reset(SDL_CreateRenderer(out->window_.get(), -1, 0));
    if (!out->renderer_) out->renderer_.reset(SDL_CreateRenderer(out->window_.get(), -1, SDL_RENDERER_SOFTWARE));
    if (!out->renderer_) return failed("no renderer");
    out->title_ = title;
    if (fullscreen) out->set_fullscreen(true);
    return out;
}

void Window::set_title(const std::string& title) {
    if (title == title_) return;
    title_ = title;
    SDL_SetWindowTitle(window_.get(), title.c_str());
}

void Window::set_fullscreen(bool on) {
    fullscreen_ = on;
    SDL_ShowCursor(on ? SDL_DISABLE : SDL_ENABLE);
    if (has_window_manager(window_.get()))
        SDL_SetWindowFullscreen(window_.get(), on ? SDL_WINDOW_FULLSCREEN_DESKTOP : 0);
    else put_by_hand(on);
}

/// Over the screen, or back: a node that only shows the wall has nobody to ask.
void Window::put_by_hand(bool over_screen) {
    SDL_Rect to = windowed_;
    if (over_screen) {
        SDL_GetWindowPosition(window_.get(), &windowed_.x, &windowed_.y);
        SDL_GetWindowSize(window_.get(), &windowed_.w, &windowed_.h);
        if (SDL_GetDisplayBounds(std::max(0, SDL_GetWindowDisplayIndex(window_.get())), &to) != 0) return;
    }
    SDL_SetWindowPosition(window_.get(), to.x, to.y);
    SDL_SetWindowSize(window_.get(), to.w, to.h);
}

Window::Size Window::size() const {
    Size out;
    SDL_GetRendererOutputSize(renderer_.get(), &out.width, &out.height);
    return out;
}

Result<void> Window::set_picture(const codec::FrameView& picture) {
    const Size size{static_cast<int>(picture.width), static_cast<int>(picture.height)};
    if (!texture_ || size != picture_) {
        texture_.reset(SDL_CreateTexture(renderer_.get(), SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STREAMING,
                                         size.width, size.height));
        if (!texture_) return failed("no texture");
        SDL_SetTextureBlendMode(texture_.get(), SDL_BLENDMODE_NONE);
        picture_ = size;
    }
    if (SDL_UpdateTexture(texture_.get(), nullptr, picture.pixels, static_cast<int>(picture.stride)) != 0)
        return failed("no picture");
    return {};
}

void Window::draw() {
    SDL_SetRenderDrawColor(renderer_.get(), 0, 0, 0, 255);
    SDL_RenderClear(renderer_.get());
    const auto window = size();
    const auto at = letterbox(picture_.width, picture_.height, window.width, window.height);
    const SDL_Rect rect{at.x, at.y, at.width, at.height};
    if (texture_) SDL_RenderCopy(renderer_.get(), texture_.get(), nullptr, &rect);
    SDL_RenderPresent(renderer_.get());
}

}  // namespace wall::wallview
