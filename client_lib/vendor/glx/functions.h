// SPDX-License-Identifier: MIT
// The GLX functions by name, for GLVND: implementations (getProcAddress), and for those outside of GLX 1.4 the
// vendor-neutral stubs that find the vendor to call (getDispatchAddress).
#pragma once

#include <GL/glx.h>
#include <glvnd/libglxabi.h>

#include <span>

namespace wall::client::glx {

using Function = void (*)();

struct NamedFunction {
    const char* name;
    Function function;
};

/// GLX 1.4 and glXCreateContextAttribsARB.
std::span<const NamedFunction> core_functions();
/// Those of extensions.
std::span<const NamedFunction> extension_functions();

/// GLVND's side of the stubs.
void start_dispatch(const __GLXapiExports& exports);
Function dispatch_stub(const char* name);
void set_dispatch_index(const char* name, int index);

/// glXUseXFont's work: one display list with a glBitmap for each glyph. False if there is no such font.
bool use_x_font(Display* display, Font font, int first, int count, int list_base);

}  // namespace wall::client::glx
