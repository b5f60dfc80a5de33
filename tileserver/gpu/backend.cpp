// SPDX-License-Identifier: MIT
#include "tileserver/gpu/backend.h"

namespace wall::tileserver {

Result<std::unique_ptr<GlBackend>> open_backend(const BackendChoice& choice) {
    if (choice.name == "egl") return open_egl_backend(choice.gpu);
    if (choice.name == "osmesa") return open_osmesa_backend();
    return fail("unknown backend \"" + choice.name + "\", expected \"egl\" or \"osmesa\"");
}

}  // namespace wall::tileserver
