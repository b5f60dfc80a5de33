// SPDX-License-Identifier: MIT
#pragma once

#include <SDL.h>

namespace wall::wallview {

/// Whether somebody can be asked to make a window full screen: X may run without a window manager. Main thread.
bool has_window_manager(SDL_Window* window);

}  // namespace wall::wallview
