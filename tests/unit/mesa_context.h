// SPDX-License-Identifier: MIT
// A plain Mesa context without a window (llvmpipe), which tests ask what OpenGL really answers.
#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <memory>

#include "gen/glapi/gl_functions.gen.h"

namespace wall::test {

class MesaContext {
public:
    /// Null if there is no Mesa here, or it does not offer what is needed. Of OpenGL 4.5, compatibility profile.
    static std::unique_ptr<MesaContext> open() {
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     4,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     5,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT,
                                     EGL_NONE};
        return open(EGL_OPENGL_API, attributes);
    }
    /// The same of OpenGL ES 3.2.
    static std::unique_ptr<MesaContext> open_es() {
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2, EGL_NONE};
        return open(EGL_OPENGL_ES_API, attributes);
    }
    /// The same of OpenGL ES 1.1.
    static std::unique_ptr<MesaContext> open_es1() {
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 1, EGL_NONE};
        return open(EGL_OPENGL_ES_API, attributes);
    }
    ~MesaContext() {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
    }

    glapi::GlFunctions gl;

private:
    static std::unique_ptr<MesaContext> open(EGLenum api, const EGLint* attributes) {
        ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        const EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
        if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr) || !eglBindAPI(api)) return nullptr;
        const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
        if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
            return nullptr;
        return std::unique_ptr<MesaContext>(new MesaContext(display, context));
    }
    MesaContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {
        gl.load([](const char* name) { return reinterpret_cast<void*>(eglGetProcAddress(name)); });
    }
    EGLDisplay display_;
    EGLContext context_;
};

}  // namespace wall::test
