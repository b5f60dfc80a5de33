// SPDX-License-Identifier: MIT
// A window of the desktop with one picture in it, through SDL 2 and whatever renderer it finds, software too. Main
// thread.
#pragma once

#include <SDL.h>

#include <memory>
#include <string>

#include "common/codec/frame.h"

namespace wall::wallview {

class Window {
public:
    struct Size {
        int width = 960, height = 540;  ///< pixels
        bool operator==(const Size&) const = default;
    };
    /// SDL's video must be on.
    static Result<std::unique_ptr<Window>> open(const std::string& title, const Size& size, bool fullscreen);

    void set_title(const std::string& title);
    void set_fullscreen(bool on);
    void toggle_fullscreen() { set_fullscreen(!fullscreen_); }
    Size size() const;
    /// Another picture, RGBA.
    Result<void> set_picture(const codec::FrameView& picture);
    /// Draws what there is.
    void draw();

private:
    template <auto destroy>
    struct With {
        void operator()(auto* thing) const { destroy(thing); }
    };
    Window() = default;
    void put_by_hand(bool over_screen);

    std::unique_ptr<SDL_Window, With<SDL_DestroyWindow>> window_;
    std::unique_ptr<SDL_Renderer, With<SDL_DestroyRenderer>> renderer_;
    std::unique_ptr<SDL_Texture, With<SDL_DestroyTexture>> texture_;
    Size picture_{0, 0};
    std::string title_;
    bool fullscreen_ = false;
    SDL_Rect windowed_{};  ///< where it was before it was put over the screen by hand
};

}  // namespace wall::wallview
