// SPDX-License-Identifier: MIT
// What GLVND's libGLX calls when it has loaded the library. Nothing is connected here: programs' children load it too.
#include <GL/glx.h>
#include <glvnd/libglxabi.h>

#include <cstring>

#include "client_lib/context/core.h"
#include "client_lib/process/log.h"
#include "client_lib/process/process.h"
#include "client_lib/vendor/glx/functions.h"
#include "client_lib/vendor/guarded.h"
#include "common/base/quoted.h"

namespace wall::client::glx {
namespace {

Bool is_screen_supported(Display*, int) { return True; }

void* find(std::span<const NamedFunction> functions, const char* name) {
    for (const auto& f : functions)
        if (std::strcmp(f.name, name) == 0) return reinterpret_cast<void*>(f.function);
    return nullptr;
}

void* get_proc_address(const GLubyte* text) {
    return vendor::guarded("getProcAddress", static_cast<void*>(nullptr), [&]() -> void* {
        const auto* name = reinterpret_cast<const char*>(text);
        if (std::strncmp(name, "glX", 3) != 0) return reinterpret_cast<void*>(gl_proc_address(name));
        void* found = find(core_functions(), name);
        return found ? found : find(extension_functions(), name);
    });
}

void* get_dispatch_address(const GLubyte* name) {
    return reinterpret_cast<void*>(dispatch_stub(reinterpret_cast<const char*>(name)));
}

void set_index(const GLubyte* name, int index) { set_dispatch_index(reinterpret_cast<const char*>(name), index); }

}  // namespace
}  // namespace wall::client::glx

extern "C" [[gnu::visibility("default")]] Bool __glx_Main(std::uint32_t version, const __GLXapiExports* exports,
                                                          __GLXvendorInfo*, __GLXapiImports* imports) {
    using namespace wall::client;
    if (GLX_VENDOR_ABI_GET_MAJOR_VERSION(version) != GLX_VENDOR_ABI_MAJOR_VERSION) return False;
    watch_forks();
    glx::start_dispatch(*exports);
    imports->isScreenSupported = glx::is_screen_supported;
    imports->getProcAddress = glx::get_proc_address;
    imports->getDispatchAddress = glx::get_dispatch_address;
    imports->setDispatchIndex = glx::set_index;
    log(LogLevel::info, "loaded window_system=glx program=%s", wall::in_quotes(program_name()).c_str());
    return True;
}
