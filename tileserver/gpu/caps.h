// SPDX-License-Identifier: MIT
// What the driver offers, for clients that answer glGetString and glGet by themselves. Render thread.
#pragma once

#include <string>
#include <vector>

#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

struct GlCaps {
    std::string vendor, renderer, version, shading_language_version;
    std::string extensions;  ///< separated by blanks
    struct Limit {
        GLenum name;
        std::vector<double> values;
    };
    std::vector<Limit> limits;
};

GlCaps query_caps(const Gl& gl);

}  // namespace wall::tileserver
