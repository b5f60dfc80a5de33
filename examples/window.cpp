// SPDX-License-Identifier: MIT
#include "examples/window.h"

#include <cstdio>
#include <cstdlib>

namespace example {
namespace {

template <class T>
T need(T thing, const char* title, const char* missing) {
    if (thing) return thing;
    std::fprintf(stderr, "%s: %s\n", title, missing);
    std::exit(1);
}

}  // namespace

Window::Window(const char* title, int width, int height)
    : display_(need(XOpenDisplay(nullptr), title, "cannot open the display; is DISPLAY set?")) {
    int wanted[] = {GLX_RGBA, GLX_DOUBLEBUFFER, GLX_DEPTH_SIZE, 24, 0};
    XVisualInfo* visual =
        need(glXChooseVisual(display_, DefaultScreen(display_), wanted), title, "no visual with a depth buffer");
    XSetWindowAttributes attributes{};
    const ::Window root = RootWindow(display_, visual->screen);
    attributes.colormap = XCreateColormap(display_, root, visual->visual, AllocNone);
    window_ = XCreateWindow(display_, root, 0, 0, static_cast<unsigned>(width), static_cast<unsigned>(height), 0,
                            visual->depth, InputOutput, visual->visual, CWColormap, &attributes);
    close_ = XInternAtom(display_, "WM_DELETE_WINDOW", False);
    XSetWMProtocols(display_, window_, &close_, 1);
    XStoreName(display_, window_, title);
    XMapWindow(display_, window_);
    context_ = need(glXCreateContext(display_, visual, nullptr, True), title, "no OpenGL context");
    XFree(visual);
    need(glXMakeCurrent(display_, window_, context_), title, "the context cannot be made current");
}

Window::~Window() {
    glXMakeCurrent(display_, None, nullptr);
    glXDestroyContext(display_, context_);
    XCloseDisplay(display_);
}

bool Window::is_open() {
    while (XPending(display_) > 0) {
        XEvent event;
        XNextEvent(display_, &event);
        if (event.type == ClientMessage && static_cast<Atom>(event.xclient.data.l[0]) == close_) open_ = false;
    }
    return open_;
}

}  // namespace example
