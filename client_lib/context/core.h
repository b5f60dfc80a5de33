// SPDX-License-Identifier: MIT
// The seam between the window-system vendors (vendor/glx, vendor/egl) and the core they share. Nothing in here knows
// GLX or EGL. Functions may be called by any application thread; none throws, none calls back into GLVND.
#pragma once

#include <cstdint>
#include <memory>

#include "client_lib/follow/surface_options.h"

namespace wall::client {

class Context;
class ClientSurface;

struct ContextOptions {
    Context* share = nullptr;  ///< same share group as this one
    int major = 1, minor = 0;  ///< least version wanted
    bool core_profile = false;
    bool es = false;  ///< of OpenGL ES, and so are the versions
    bool debug = false, forward_compatible = false;
    bool robust = false, notifies_of_resets = false;
};

/// The connection to the wall is made here, at a process's first make_current, never before: children of the
/// application inherit its environment. An error's text names the address tried and the remedy.
std::shared_ptr<ClientSurface> create_surface(SurfaceOptions options);
/// Whether contexts of OpenGL ES of this version (1, 2, 3) are offered.
bool offers_es(int major);
/// Null if the version or profile is not offered. One of OpenGL ES has the latest version that is.
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
