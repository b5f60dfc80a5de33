// SPDX-License-Identifier: MIT
// What a surface is made with. Values.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "client_lib/link/window_messages.h"

namespace wall::client {

struct Extent {
    std::uint32_t width = 0, height = 0;  // pixels
};

/// What a framebuffer configuration promises (one row of the config matrix).
struct SurfaceFormat {
    bool double_buffered = true;
    std::uint8_t alpha_bits = 0;    // red, green, blue are 8 each
    std::uint8_t depth_bits = 24;   // 0 or 24
    std::uint8_t stencil_bits = 8;  // 0 or 8
    std::uint8_t accum_bits = 16;   // per channel, 0 or 16
    std::uint8_t samples = 0;
    bool stereo = false;  // buffers for each eye
    bool srgb = false;    ///< asked for: OpenGL ES, too, writes colours by the curve of sRGB (EGL_KHR_gl_colorspace)
    bool operator==(const SurfaceFormat&) const = default;
};

struct SurfaceOptions {
    SurfaceFormat format;
    bool visible = true;                                ///< a window; false: pbuffer, pixmap (never placed on the wall)
    bool stands_for_none = false;                       ///< a context is current without a surface
    Extent size;                                        ///< at creation
    std::function<std::optional<Extent>()> query_size;  ///< window's size now; empty function: it never changes
    std::string title;
    std::optional<NativeWindow> native;  ///< none: it is no window of the program's own
    WindowMessages messages;             ///< of a window; empty functions: it cannot be spoken to
};

}  // namespace wall::client
