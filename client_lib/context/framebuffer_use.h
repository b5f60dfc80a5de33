// SPDX-License-Identifier: MIT
// The framebuffer objects of a context, which of them it draws to and reads from, and its renderbuffer (OpenGL 4.6,
// chapter 9). Framebuffers belong to one context; renderbuffers and textures, which are attached to them, to its share
// group. What is done with them: framebuffer_binding.h. The context's thread.
#pragma once

#include <cstdint>
#include <memory>

#include "client_lib/objects/framebuffer.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

struct FramebufferUse {
    NameTable<Framebuffer> names;
    std::shared_ptr<Framebuffer> draw, read;     ///< null: the surface
    std::shared_ptr<Renderbuffer> renderbuffer;  ///< bound; null: none
    std::uint64_t stamp = 0;                     ///< of the latest change of bindings or of what is bound
};

}  // namespace wall::client
