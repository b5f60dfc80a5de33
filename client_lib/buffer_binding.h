// SPDX-License-Identifier: MIT
// Which buffer object a context has at a target, and reading it, for the commands that take "a pointer, or an offset if
// a buffer is bound". Application threads.
#pragma once

#include <memory>
#include <span>

#include "client_lib/context.h"
#include "client_lib/objects/buffer.h"

namespace wall::client {

/// The context's binding of a target: a buffer's id; null: no such target.
std::uint32_t* buffer_binding(Context& c, GLenum target);

/// The buffer of an id; null: none, or it was deleted.
std::shared_ptr<Buffer> buffer_of(Context& c, std::uint32_t id);

/// The content that a pointer given while `buffer` was bound stands for, from its offset on. It stays while the
/// application changes no buffer. Empty: the buffer is gone, or the offset lies behind its end.
std::span<const std::byte> buffer_content(Context& c, std::uint32_t buffer, std::uintptr_t offset);

/// The source of an image command (GL_PIXEL_UNPACK_BUFFER) of `bytes` bytes; null with an error if it reaches over the
/// buffer's end. Without a buffer, `pointer` itself.
const void* unpack_source(Context& c, const void* pointer, std::size_t bytes);
/// The same for a command that writes (GL_PIXEL_PACK_BUFFER).
void* pack_target(Context& c, void* pointer, std::size_t bytes);

}  // namespace wall::client
