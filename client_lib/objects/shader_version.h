// SPDX-License-Identifier: MIT
// The version that a shader says it is written in (GLSL ES 1.00, 3.4; GLSL 1.10, 3.3). Pure.
#pragma once

#include <string>
#include <string_view>

namespace wall::client {

struct ShaderVersion {
    bool given = false;   ///< there is a #version in front of everything else
    unsigned number = 0;  ///< 100, 120, 300
    bool es = false;      ///< 100, or "es" behind the number
};

/// Only comments and blanks stand in front of it.
ShaderVersion version_of_shader(std::string_view source);

/// What the compiler of a context of OpenGL ES of a version (times ten) is given.
struct EsSource {
    std::string source;  ///< with a version: one without is of 1.00, which a desktop compiler does not know by itself
    std::string error;   ///< not empty: no such context takes it
};
EsSource es_source(std::string source, unsigned es_version);

}  // namespace wall::client
