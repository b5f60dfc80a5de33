// SPDX-License-Identifier: MIT
// A vendor of GLX and EGL for GLVND: Mesa's, with some functions replaced (calls.h).
#include <EGL/egl.h>
#include <GL/glx.h>
#include <dlfcn.h>
#include <glvnd/libeglabi.h>
#include <glvnd/libglxabi.h>

#include <cstring>
#include <mutex>
#include <set>

#include "tests/golden/moved/calls.h"
#include "tests/golden/moved/place.h"

namespace golden::moved {
namespace {

/// Contexts that have been current. A handle may be used anew once its context is destroyed.
class Known {
public:
    bool add(const void* context) {
        const std::lock_guard lock(mutex_);
        return contexts_.insert(context).second;
    }
    void remove(const void* context) {
        const std::lock_guard lock(mutex_);
        contexts_.erase(context);
    }

private:
    std::mutex mutex_;
    std::set<const void*> contexts_;
};

Known& known() {
    static auto* const contexts = new Known;
    return *contexts;
}

void was_bound(const void* context) {
    if (context != nullptr && known().add(context)) move_new_context();
}

template <class Function>
Function entry_of(const char* library, const char* name) {
    void* handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    void* found = handle != nullptr ? dlsym(handle, name) : nullptr;
    if (found == nullptr) stop(library);
    return reinterpret_cast<Function>(found);
}

// ---- GLX ----

decltype(__GLXapiImports::getProcAddress) g_mesa_glx = nullptr;

void* glx_function(const char* name) { return g_mesa_glx(reinterpret_cast<const GLubyte*>(name)); }

template <class... Arguments>
Bool make_current(const char* name, GLXContext context, Arguments... arguments) {
    const auto mesa = reinterpret_cast<Bool (*)(Arguments...)>(glx_function(name));
    if (mesa(arguments...) == False) return False;
    was_bound(context);
    return True;
}

Bool glx_make_current(Display* display, GLXDrawable drawable, GLXContext context) {
    return make_current("glXMakeCurrent", context, display, drawable, context);
}
Bool glx_make_context_current(Display* display, GLXDrawable draw, GLXDrawable read, GLXContext context) {
    return make_current("glXMakeContextCurrent", context, display, draw, read, context);
}
void glx_destroy_context(Display* display, GLXContext context) {
    known().remove(context);
    reinterpret_cast<decltype(&glXDestroyContext)>(glx_function("glXDestroyContext"))(display, context);
}

void* glx_proc_address(const GLubyte* text) {
    const auto* name = reinterpret_cast<const char*>(text);
    void* found = g_mesa_glx(text);
    if (found == nullptr) return nullptr;
    if (std::strcmp(name, "glXMakeCurrent") == 0) return reinterpret_cast<void*>(&glx_make_current);
    if (std::strcmp(name, "glXMakeContextCurrent") == 0) return reinterpret_cast<void*>(&glx_make_context_current);
    if (std::strcmp(name, "glXDestroyContext") == 0) return reinterpret_cast<void*>(&glx_destroy_context);
    void* replaced = replacement(name);
    return replaced != nullptr ? replaced : found;
}

// ---- EGL ----

decltype(__EGLapiImports::getProcAddress) g_mesa_egl = nullptr;

void* egl_function(const char* name) { return g_mesa_egl(name); }

EGLBoolean egl_make_current(EGLDisplay display, EGLSurface draw, EGLSurface read, EGLContext context) {
    const auto mesa = reinterpret_cast<decltype(&eglMakeCurrent)>(egl_function("eglMakeCurrent"));
    if (mesa(display, draw, read, context) == EGL_FALSE) return EGL_FALSE;
    was_bound(context);
    return EGL_TRUE;
}
EGLBoolean egl_destroy_context(EGLDisplay display, EGLContext context) {
    known().remove(context);
    return reinterpret_cast<decltype(&eglDestroyContext)>(egl_function("eglDestroyContext"))(display, context);
}

void* egl_proc_address(const char* name) {
    void* found = g_mesa_egl(name);
    if (found == nullptr) return nullptr;
    if (std::strcmp(name, "eglMakeCurrent") == 0) return reinterpret_cast<void*>(&egl_make_current);
    if (std::strcmp(name, "eglDestroyContext") == 0) return reinterpret_cast<void*>(&egl_destroy_context);
    void* replaced = replacement(name);
    return replaced != nullptr ? replaced : found;
}

}  // namespace
}  // namespace golden::moved

extern "C" [[gnu::visibility("default")]] Bool __glx_Main(std::uint32_t version, const __GLXapiExports* exports,
                                                          __GLXvendorInfo* vendor, __GLXapiImports* imports) {
    using namespace golden::moved;
    const auto mesa = entry_of<__PFNGLXMAINPROC>("libGLX_mesa.so.0", "__glx_Main");
    if (mesa(version, exports, vendor, imports) == False) return False;
    g_mesa_glx = imports->getProcAddress;
    use(glx_function);
    imports->getProcAddress = glx_proc_address;
    return True;
}

extern "C" [[gnu::visibility("default")]] EGLBoolean __egl_Main(std::uint32_t version, const __EGLapiExports* exports,
                                                                __EGLvendorInfo* vendor, __EGLapiImports* imports) {
    using namespace golden::moved;
    const auto mesa = entry_of<__PFNEGLMAINPROC>("libEGL_mesa.so.0", "__egl_Main");
    if (mesa(version, exports, vendor, imports) == EGL_FALSE) return EGL_FALSE;
    g_mesa_egl = imports->getProcAddress;
    use(egl_function);
    imports->getProcAddress = egl_proc_address;
    return EGL_TRUE;
}
