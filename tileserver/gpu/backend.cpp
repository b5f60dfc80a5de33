// SPDX-License-Identifier: MIT
#include "tileserver/gpu/backend.h"

namespace wall::tileserver {

Result<std::unique_ptr<GlBackend>> open_backend(std::string_view name) {
    if (name == "egl") return open_egl_backend();
    if (name == "osmesa") return open_osmesa_backend();
    return fail("unknown backend \"" + std::string(name) + "\", expected \"egl\" or \"osmesa\"");
}

}  // namespace wall::tileserver
