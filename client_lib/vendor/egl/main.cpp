// SPDX-License-Identifier: MIT
// What GLVND's libEGL calls when it has loaded the library. Nothing is connected here: programs' children load it too.
#include <cstdlib>
#include <cstring>

#include "client_lib/context/core.h"
#include "client_lib/process/log.h"
#include "client_lib/process/process.h"
#include "client_lib/vendor/egl/functions.h"
#include "client_lib/vendor/guarded.h"
#include "common/base/quoted.h"

namespace wall::client::egl {
namespace {

EGLBoolean supports_api(EGLenum api) { return api == EGL_OPENGL_API || api == EGL_OPENGL_ES_API; }

const char* vendor_string(int name) {
    return name == __EGL_VENDOR_STRING_PLATFORM_EXTENSIONS ? kPlatformExtensions : nullptr;
}

void* get_proc_address(const char* name) {
    return vendor::guarded("getProcAddress", static_cast<void*>(nullptr), [&]() -> void* {
        if (std::strncmp(name, "egl", 3) != 0) return reinterpret_cast<void*>(gl_proc_address(name));
        for (const auto& f : functions())
            if (std::strcmp(f.name, name) == 0) return reinterpret_cast<void*>(f.function);
        return nullptr;
    });
}

/// Installed beside the system's own manifests the library is offered to every EGL program: it is for those on the
/// wall.
bool meant_for_us() {
    const char* manifests = secure_getenv("__EGL_VENDOR_LIBRARY_FILENAMES");
    const char* glx_vendor = secure_getenv("__GLX_VENDOR_LIBRARY_NAME");
    return (manifests && *manifests) || (glx_vendor && std::strcmp(glx_vendor, "wallgl") == 0);
}

}  // namespace
}  // namespace wall::client::egl

extern "C" [[gnu::visibility("default")]] EGLBoolean __egl_Main(std::uint32_t version, const __EGLapiExports* exports,
                                                                __EGLvendorInfo*, __EGLapiImports* imports) {
    using namespace wall::client;
    if (EGL_VENDOR_ABI_GET_MAJOR_VERSION(version) != EGL_VENDOR_ABI_MAJOR_VERSION) return EGL_FALSE;
    if (!egl::meant_for_us()) return EGL_FALSE;
    watch_forks();
    egl::start(*exports);
    egl::start_dispatch(*exports);
    imports->getPlatformDisplay = egl::get_platform_display;
    imports->getSupportsAPI = egl::supports_api;
    imports->getVendorString = egl::vendor_string;
    imports->getProcAddress = egl::get_proc_address;
    imports->getDispatchAddress = egl::dispatch_address;
    imports->setDispatchIndex = egl::set_dispatch_index;
    log(LogLevel::info, "loaded window_system=egl program=%s", wall::in_quotes(program_name()).c_str());
    return EGL_TRUE;
}
