// SPDX-License-Identifier: MIT
// The seam between the window-system vendors (vendor/glx, vendor/egl) and the core they share. Nothing in here knows
// GLX or EGL. Functions may be called by any application thread; none throws, none calls back into GLVND.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "client_lib/link/window_messages.h"

namespace wall::client {

class Context;
class ClientSurface;

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
};

struct SurfaceOptions {
    SurfaceFormat format;
    bool visible = true;                                ///< a window; false: pbuffer, pixmap (never placed on the wall)
    Extent size;                                        ///< at creation
    std::function<std::optional<Extent>()> query_size;  ///< window's size now; empty function: it never changes
    std::string title;
    WindowMessages messages;  ///< of a window; empty functions: it cannot be spoken to
};

struct ContextOptions {
    Context* share = nullptr;  ///< same share group as this one
    int major = 1, minor = 0;  ///< least version wanted
    bool core_profile = false;
    bool debug = false, forward_compatible = false;
};

/// The connection to the wall is made here, at a process's first make_current, never before: children of the
/// application inherit its environment. An error's text names the address tried and the remedy.
std::shared_ptr<ClientSurface> create_surface(SurfaceOptions options);
/// Null if the version or profile is not offered.
std::shared_ptr<Context> create_context(const ContextOptions& options);

/// Makes `context` the calling thread's own with these surfaces (all null: releases). False if the wall cannot be
/// reached (one clear line went to stderr) or another thread holds the context.
bool make_current(std::shared_ptr<Context> context, std::shared_ptr<ClientSurface> draw,
                  std::shared_ptr<ClientSurface> read);
Context* current_context();

/// glXCopyContext: copies what glPushAttrib(mask) would save. `to` must not be current in any thread, `from` not in
/// another one.
void copy_context(Context& from, Context& to, std::uint32_t mask);

/// Ends a frame of `surface`: everything drawn so far becomes its next picture on the wall. Blocks only when the wall
/// is more than two frames behind.
void swap_buffers(ClientSurface& surface);
Extent surface_size(const ClientSurface& surface);

/// Everything queued is sent (glXWaitGL, eglWaitClient); `wait` also waits until it is drawn.
void flush_current(bool wait);

/// Entry point of a GL function by name, aliases included; null if gl.xml has no such function.
using ProcAddress = void (*)();
ProcAddress gl_proc_address(const char* name);

}  // namespace wall::client
