// SPDX-License-Identifier: MIT
// A part of a window, of which each node holds its own, gathered and given to all of them. The context's thread.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/context/own_framebuffer.h"
#include "client_lib/context/readback.h"
#include "client_lib/objects/texture.h"

namespace wall::client {

/// The part as a framebuffer object of its own, while it lives the one that is read from. The window's buffers of
/// `mask` (GL_COLOR_BUFFER_BIT: the one that is read from) are gathered where it is made, which `function` waits for.
class GatheredWindow {
public:
    GatheredWindow(Context& c, const PixelBox& box, GLbitfield mask, const char* function);
    ~GatheredWindow();
    GatheredWindow(const GatheredWindow&) = delete;

private:
    void attach_depth(Framebuffer& to, const PixelBox& box);
    void attach(Framebuffer& to, unsigned place, const PixelBox& box, GLint internal_format, GLenum format,
                GLenum type);

    Context& c_;
    const char* const function_;
    std::vector<std::shared_ptr<Texture>> textures_;
    std::optional<OwnFramebuffer> made_;
};

/// What a blit to a box may touch: where a scaled window rounds, a little more.
PixelRect touched_by_blit(const PixelBox& box);

/// All nodes draw all of the window from now on, and have all of its back buffer, depth and stencil (or front buffer,
/// where it has no other). False: it is a parallel program's, which cannot be so, or one with buffers for
/// two eyes in mid-frame.
bool turn_whole(Context& c, ClientSurface& window);

/// A copy out of the window that is read from, since no framebuffer object is: whether every node has all of it and
/// may copy by itself. That becomes so where a program makes many copies in every frame (copy_habit.h).
bool can_copy_out_of_window(Context& c);

}  // namespace wall::client
