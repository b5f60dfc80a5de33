// SPDX-License-Identifier: MIT
// Fragment shaders of a few lines that keep compilers busy for ages, and take all memory.
#pragma once

#include <string>

namespace wall::tileserver::test {

/// When it is linked: each function calls the one before it twice, and calls are put in line.
inline std::string monstrous_shader(unsigned depth = 30) {
    std::string text = "float f0(float x) { return x * x + 1.0; }\n";
    for (unsigned i = 1; i <= depth; ++i) {
        const std::string before = "f" + std::to_string(i - 1);
        text += "float f" + std::to_string(i) + "(float x) { return " + before + "(x) + " + before +
                "(x * 0.5 + 0.25); }\n";
    }
    return text + "void main() { gl_FragColor = vec4(f" + std::to_string(depth) + "(gl_FragCoord.x)); }\n";
}

/// When it is compiled: each macro is the one before it twice.
inline std::string monstrous_macros(unsigned depth = 40) {
    std::string text = "#define M0 x += 1.0;\n";
    for (unsigned i = 1; i <= depth; ++i) {
        const std::string before = "M" + std::to_string(i - 1);
        text += "#define M" + std::to_string(i) + " " + before + " " + before + "\n";
    }
    return text + "void main() { float x = 0.0; M" + std::to_string(depth) + " gl_FragColor = vec4(x); }\n";
}

}  // namespace wall::tileserver::test
