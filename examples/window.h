// SPDX-License-Identifier: MIT
// A GLX window with a current context: nothing of it is special to a wall. Each process of a parallel program opens its
// own, and on the wall they are one.
#pragma once

#include <GL/glx.h>

namespace example {

class Window {
public:
    /// Ends the program with a message, which begins with `title`, if there is no display or no such visual.
    Window(const char* title, int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    void swap() { glXSwapBuffers(display_, window_); }
    /// False: somebody has closed it.
    bool is_open();

private:
    Display* display_;
    ::Window window_ = 0;
    GLXContext context_ = nullptr;
    Atom close_ = 0;
    bool open_ = true;
};

}  // namespace example
