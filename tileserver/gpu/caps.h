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

/// By the renderer's name: it is a program that draws on the processor, such as Mesa's llvmpipe.
bool is_software(const GlCaps& caps);

}  // namespace wall::tileserver
