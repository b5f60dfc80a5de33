// SPDX-License-Identifier: MIT
// What can be said to a program through its window. The window systems say how; the control link's thread says it, with
// no lock held, never the application's.
#pragma once

#include <functional>

namespace wall::client {

struct WindowMessages {
    std::function<bool()> close;   ///< asks it to close, as a window manager would; false: there is no way to ask
    std::function<void()> redraw;  ///< asks it to draw its window again
};

}  // namespace wall::client
