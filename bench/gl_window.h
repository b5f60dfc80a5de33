// SPDX-License-Identifier: MIT
// A GLX window with a context that is current, for the programs that are measured.
#pragma once

#include <GL/gl.h>
#include <GL/glx.h>

#include <cstdio>

namespace wall::bench {

class GlWindow {
public:
    /// `attributes`: as glXChooseVisual takes them. Where that fails it says so on stderr and current() is false.
    GlWindow(const char* program, unsigned width, unsigned height, const int* attributes)
        : display_(XOpenDisplay(nullptr)) {
        if (!display_) {
            complain(program, "cannot open the display; is DISPLAY set?");
            return;
        }
        XVisualInfo* visual = glXChooseVisual(display_, DefaultScreen(display_), const_cast<int*>(attributes));
        if (!visual) {
            complain(program, "no such visual");
            return;
        }
        XSetWindowAttributes wanted{};
        const Window root = RootWindow(display_, visual->screen);
        wanted.colormap = XCreateColormap(display_, root, visual->visual, AllocNone);
        window_ = XCreateWindow(display_, root, 0, 0, width, height, 0, visual->depth, InputOutput, visual->visual,
                                CWColormap, &wanted);
        XMapWindow(display_, window_);
        context_ = glXCreateContext(display_, visual, nullptr, True);
        current_ = glXMakeCurrent(display_, window_, context_) != False;
        if (!current_) complain(program, "no context");
        XFree(visual);
    }
    ~GlWindow() {
        if (!display_) return;
        glXMakeCurrent(display_, None, nullptr);
        if (context_) glXDestroyContext(display_, context_);
        XCloseDisplay(display_);
    }
    GlWindow(const GlWindow&) = delete;

    bool current() const { return current_; }
    void swap() { glXSwapBuffers(display_, window_); }

private:
    static void complain(const char* program, const char* what) { std::fprintf(stderr, "%s: %s\n", program, what); }

    Display* display_ = nullptr;
    Window window_ = 0;
    GLXContext context_ = nullptr;
    bool current_ = false;
};

}  // namespace wall::bench
