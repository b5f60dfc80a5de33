// SPDX-License-Identifier: MIT
// Messages to the windows of an X server, over a connection of our own for just that message: the application's must
// not be used outside of its own calls. Blocks as long as the server does. Any thread.
#pragma once

#include <xcb/xcb.h>

#include <string>

#include "client_lib/link/window_messages.h"

namespace wall::client::vendor {

/// To `window` of the server with that name (empty: DISPLAY). A window inside of a toolkit's is closed by the one
/// around it that takes WM_DELETE_WINDOW.
WindowMessages window_messages(std::string display, xcb_window_t window);

/// A window was asked to close within the last seconds: it may be gone without a word.
bool close_was_asked();

}  // namespace wall::client::vendor
