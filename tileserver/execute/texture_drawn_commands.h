// SPDX-License-Identifier: MIT
// Group [texture_drawn]: of textures whose content may have been drawn. Render thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tileserver/driver/image_extent.h"
#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class TextureDrawnCommands {
public:
    /// `execution` outlives it.
    explicit TextureDrawnCommands(Execution& execution) : execution_(execution) {}

    void TexMipmaps(ClientName texture, GLenum target, std::int32_t base, std::int32_t last);
    void TexRead(RequestId request, ClientName texture, GLenum target, std::int32_t level, std::int32_t slice,
                 std::int32_t first_row, std::int32_t rows, GLenum format, GLenum type);

private:
    /// One of a texture, which is bound to be edited.
    struct Image {
        GLuint name;
        GLenum target;
        std::int32_t level;
        bool is_face;
        ImageExtent extent;
    };
    /// Rows of a slice of it, and as what they are wanted.
    struct Part {
        std::int32_t slice, first_row, rows;
        GLenum format, type;
    };
    /// Tight rows; none where there is no such part.
    std::vector<std::byte> read(const Image& image, const Part& part);
    void read_face(const Image& image, const Part& part, std::span<std::byte> to);

    Execution& execution_;
};

}  // namespace wall::tileserver
