// SPDX-License-Identifier: MIT
// How the X server lays out a window's pixels. For files that include Xlib anyway. Render thread.
#pragma once

#include <X11/Xlib.h>
#include <X11/Xutil.h>

namespace wall::tileserver {

/// Null: the server has no visual of that name with true colours and so many bits a pixel.
inline Visual* true_color_visual(Display* display, VisualID id, int depth) {
    XVisualInfo wanted{};
    wanted.visualid = id;
    wanted.depth = depth;
    wanted.c_class = TrueColor;
    int count = 0;
    XVisualInfo* found = XGetVisualInfo(display, VisualIDMask | VisualDepthMask | VisualClassMask, &wanted, &count);
    Visual* visual = count > 0 ? found->visual : nullptr;
    if (found != nullptr) XFree(found);
    return visual;
}

}  // namespace wall::tileserver
