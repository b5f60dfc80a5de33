// SPDX-License-Identifier: MIT
// A fragment shader of a few lines that keeps compilers busy for ages: each function calls the one before it twice, and
// they put calls in line.
#pragma once

#include <string>

namespace wall::tileserver::test {

inline std::string monstrous_shader(unsigned depth = 30) {
    std::string text = "float f0(float x) { return x * x + 1.0; }\n";
    for (unsigned i = 1; i <= depth; ++i) {
        const std::string before = "f" + std::to_string(i - 1);
        text += "float f" + std::to_string(i) + "(float x) { return " + before + "(x) + " + before +
                "(x * 0.5 + 0.25); }\n";
    }
    return text + "void main() { gl_FragColor = vec4(f" + std::to_string(depth) + "(gl_FragCoord.x)); }\n";
}

}  // namespace wall::tileserver::test
