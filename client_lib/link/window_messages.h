// SPDX-License-Identifier: MIT
// What can be said to a program through its window. The window systems say how; the control link's thread says it, with
// no lock held, never the application's.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace wall::client {

/// A window of an X server, as other programs of the machine find it.
struct NativeWindow {
    std::string display;       ///< as in DISPLAY
    std::uint64_t number = 0;  ///< X's, of the window
};

struct WindowMessages {
    std::function<bool()> close;   ///< asks it to close, as a window manager would; false: there is no way to ask
    std::function<void()> redraw;  ///< asks it to draw its window again
};

}  // namespace wall::client
