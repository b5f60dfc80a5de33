// SPDX-License-Identifier: MIT
// A vendor of GLX and EGL for GLVND: Mesa's, which also counts the frames that a program shows, in the first eight
// bytes (a native unsigned number) of the file that LIVE_FRAMES names and that has them. bench/live.py reads it while
// the program runs. However a program finds its functions (linked, dlsym, glXGetProcAddress), its swaps come through
// here.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glx.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <glvnd/libeglabi.h>
#include <glvnd/libglxabi.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace live {
namespace {

using Counter = std::atomic<std::uint64_t>;
static_assert(Counter::is_always_lock_free && sizeof(Counter) == 8);

Counter* open_counter() {
    static Counter nobody_reads{0};
    const char* path = std::getenv("LIVE_FRAMES");
    const int file = path != nullptr ? open(path, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) return &nobody_reads;
    void* mapped = mmap(nullptr, sizeof(Counter), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    return mapped == MAP_FAILED ? &nobody_reads : static_cast<Counter*>(mapped);
}

void count_frame() {
    static Counter* const counter = open_counter();
    counter->fetch_add(1, std::memory_order_relaxed);
}

template <class Function>
Function entry_of(const char* library, const char* name) {
    void* handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    return handle != nullptr ? reinterpret_cast<Function>(dlsym(handle, name)) : nullptr;
}

/// A function that counts a frame and then calls Mesa's.
template <class Function>
struct Counted;
template <class Result, class... Arguments>
struct Counted<Result(Arguments...)> {
    inline static Result (*mesa)(Arguments...) = nullptr;
    static Result call(Arguments... arguments) {
        count_frame();
        return mesa(arguments...);
    }
    static void* around(void* found) {
        mesa = reinterpret_cast<Result (*)(Arguments...)>(found);
        return reinterpret_cast<void*>(&call);
    }
};

using GlxSwap = Counted<void(Display*, GLXDrawable)>;
using EglSwap = Counted<EGLBoolean(EGLDisplay, EGLSurface)>;
struct WithDamageExt : Counted<EGLBoolean(EGLDisplay, EGLSurface, const EGLint*, EGLint)> {};

decltype(__GLXapiImports::getProcAddress) g_mesa_glx = nullptr;
decltype(__EGLapiImports::getProcAddress) g_mesa_egl = nullptr;

void* glx_proc_address(const GLubyte* name) {
    void* found = g_mesa_glx(name);
    const bool swap = found != nullptr && std::strcmp(reinterpret_cast<const char*>(name), "glXSwapBuffers") == 0;
    return swap ? GlxSwap::around(found) : found;
}

void* egl_proc_address(const char* name) {
    void* found = g_mesa_egl(name);
    if (found == nullptr) return nullptr;
    if (std::strcmp(name, "eglSwapBuffers") == 0) return EglSwap::around(found);
    if (std::strncmp(name, "eglSwapBuffersWithDamage", 24) == 0) return WithDamageExt::around(found);
    return found;
}

}  // namespace
}  // namespace live

extern "C" [[gnu::visibility("default")]] Bool __glx_Main(std::uint32_t version, const __GLXapiExports* exports,
                                                          __GLXvendorInfo* vendor, __GLXapiImports* imports) {
    const auto mesa = live::entry_of<__PFNGLXMAINPROC>("libGLX_mesa.so.0", "__glx_Main");
    if (mesa == nullptr || mesa(version, exports, vendor, imports) == False) return False;
    live::g_mesa_glx = imports->getProcAddress;
    imports->getProcAddress = live::glx_proc_address;
    return True;
}

extern "C" [[gnu::visibility("default")]] EGLBoolean __egl_Main(std::uint32_t version, const __EGLapiExports* exports,
                                                                __EGLvendorInfo* vendor, __EGLapiImports* imports) {
    const auto mesa = live::entry_of<__PFNEGLMAINPROC>("libEGL_mesa.so.0", "__egl_Main");
    if (mesa == nullptr || mesa(version, exports, vendor, imports) == EGL_FALSE) return EGL_FALSE;
    live::g_mesa_egl = imports->getProcAddress;
    imports->getProcAddress = live::egl_proc_address;
    return EGL_TRUE;
}
