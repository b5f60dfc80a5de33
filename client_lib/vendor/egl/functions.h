// SPDX-License-Identifier: MIT
// The EGL functions by name, for GLVND.
#pragma once

#include <EGL/egl.h>
#include <glvnd/libeglabi.h>

#include <span>

namespace wall::client::egl {

using Function = void (*)();

struct NamedFunction {
    const char* name;
    Function function;
};

std::span<const NamedFunction> functions();
/// GLVND's exports: it alone knows the API that eglBindAPI has set for a thread.
void start(const __EGLapiExports& exports);
/// GLVND asks for a stub of a function that it does not know, null: there is none, and says the number that it gives
/// it.
void start_dispatch(const __EGLapiExports& exports);
void* dispatch_address(const char* name);
void set_dispatch_index(const char* name, int index);
EGLDisplay get_platform_display(EGLenum platform, void* native, const EGLAttrib* attributes);
inline constexpr const char* kPlatformExtensions =
    "EGL_KHR_platform_x11 EGL_EXT_platform_x11 EGL_EXT_platform_xcb EGL_EXT_platform_device "
    "EGL_MESA_platform_surfaceless";

}  // namespace wall::client::egl
