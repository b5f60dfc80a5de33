// SPDX-License-Identifier: MIT
// Pixels of a surface gathered from the nodes that hold them (DESIGN, section 4: a readback is one of the few commands
// that must wait). All nodes are asked first, then waited for, so it costs one round trip.
#pragma once

#include <cstdint>
#include <vector>

#include "client_lib/context/context.h"

namespace wall::client {

/// A rectangle of window pixels, origin bottom left.
struct PixelBox {
    std::int32_t x = 0, y = 0, width = 0, height = 0;
    bool empty() const { return width <= 0 || height <= 0; }
};

/// The part of a rectangle that lies in the read surface's window.
PixelBox clip_to_window(const Context& c, const PixelBox& box);

/// Tight rows of a rectangle inside the window. Pixels that no node holds are zero. The pair of format and type is
/// allowed and not GL_BITMAP. Counted as one round trip of `function`.
std::vector<std::byte> gather_pixels(Context& c, const PixelBox& box, GLenum format, GLenum type, const char* function);

/// The same for a rectangle anywhere (what is outside the window is zero), read without pixel transfer.
std::vector<std::byte> gather_plain(Context& c, const PixelBox& box, GLenum format, GLenum type, const char* function);

}  // namespace wall::client
