// SPDX-License-Identifier: MIT
// What the EGL backends have in common: the context they all ask for, and how an error is told. Render thread.
#pragma once

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string>
#include <string_view>

namespace wall::tileserver {

/// "eglXyz failed, EGL error 0x3009": the last error of this thread, which EGL then forgets.
std::string egl_error(const char* call);
/// Null: there is no such function.
template <class Function>
Function egl_extension(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}
/// Whether an extension is in a list as eglQueryString() gives it; null is an empty list.
bool has_word(const char* list, std::string_view word);
/// OpenGL 4.5 compatibility, for surfaces of any config and for none, and robust where the driver offers that.
/// EGL_NO_CONTEXT: not to be had.
EGLContext create_egl_context(EGLDisplay display);

}  // namespace wall::tileserver
