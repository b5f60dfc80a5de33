// SPDX-License-Identifier: MIT
#include "examples/picture.h"

#include <GL/gl.h>

#include <cstddef>
#include <cstdio>
#include <vector>

namespace example {

void write_picture(const std::string& file, int width, int height) {
    const std::size_t row = static_cast<std::size_t>(width) * 3;
    std::vector<unsigned char> pixels(row * static_cast<std::size_t>(height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    std::FILE* out = std::fopen(file.c_str(), "wb");
    if (!out) return std::perror(file.c_str());
    std::fprintf(out, "P6\n%d %d\n255\n", width, height);
    for (int y = height - 1; y >= 0; --y) std::fwrite(&pixels[static_cast<std::size_t>(y) * row], 1, row, out);
    std::fclose(out);
}

}  // namespace example
