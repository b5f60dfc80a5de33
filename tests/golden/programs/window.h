// SPDX-License-Identifier: MIT
// A window with a current OpenGL context, by GLX or by EGL.
#pragma once

#include <memory>

#include "tests/golden/programs/scene.h"

namespace golden {

class Window {
public:
    virtual ~Window() = default;
    virtual void swap() = 0;
    static std::unique_ptr<Window> by_glx(Size size, const Needs& needs);
    static std::unique_ptr<Window> by_egl(Size size, const Needs& needs);
};

}  // namespace golden
