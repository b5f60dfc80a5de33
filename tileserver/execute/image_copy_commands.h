// SPDX-License-Identifier: MIT
// Group [image_copy]: texels from one image to another, in a block of a target that nobody sees, which every node has.
// Render thread.
#pragma once

#include <cstdint>
#include <optional>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

class ImageCopyCommands {
public:
    /// Both outlive it.
    ImageCopyCommands(Execution& execution, OpenBlock& block) : execution_(execution), block_(block) {}

    void CopyImage(ClientName source, GLenum source_target, std::int32_t source_level, std::int32_t source_x,
                   std::int32_t source_y, std::int32_t source_z, ClientName dest, GLenum dest_target,
                   std::int32_t dest_level, std::int32_t dest_x, std::int32_t dest_y, std::int32_t dest_z,
                   std::int32_t width, std::int32_t height, std::int32_t depth);
    void ViewMipmaps(ClientName texture, GLenum target, std::int32_t base, std::int32_t last);

private:
    /// Of an image's place: its texture or renderbuffer, and where in it.
    struct Place {
        ClientName name;
        GLenum target;
        std::int32_t level, x, y, z;
    };
    /// The driver's name; nothing, after a refusal, where there is none such or no such place. `written`: it belongs to
    /// the session alone from now on.
    std::optional<GLuint> find(const Place& place, std::int32_t depth, bool written);

    Execution& execution_;
    OpenBlock& block_;
};

}  // namespace wall::tileserver
