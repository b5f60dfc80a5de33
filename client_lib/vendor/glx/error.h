// SPDX-License-Identifier: MIT
// Errors that GLX reports through the program's X error handler.
#pragma once

#include <X11/Xlib.h>

namespace wall::client::glx {

/// `code` counts from the first error of the GLX extension (GLXBadContext = 0, ...).
void send_glx_error(Display* display, int code, XID resource, int minor_opcode);
/// A core X error: BadValue, BadMatch, BadAccess, ...
void send_x_error(Display* display, int code, XID resource, int minor_opcode);

}  // namespace wall::client::glx
