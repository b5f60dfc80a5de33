// SPDX-License-Identifier: MIT
// Which buffer objects a context has at its targets and in its arrays, and reading them, for the commands that take "a
// pointer, or an offset if a buffer is bound". A context keeps what it has: when another context of the group deletes
// an object, only its name is gone (OpenGL 2.1, appendix D). Application threads.
#pragma once

#include <memory>
#include <span>
#include <unordered_map>

#include "client_lib/context/context.h"
#include "client_lib/objects/buffer.h"

namespace wall::client {

/// The buffers that a context's bindings and arrays may name, by id. Used by the context's thread.
struct BufferUse {
    std::unordered_map<ClientName, std::shared_ptr<Buffer>> by_id;
    std::uint64_t deletions = 0;  ///< ShareGroup::buffer_deletions when deleted ones were last let go
    bool holds_deleted = false;   ///< some were still named then
    BufferReading transfer;       ///< what the latest pixel command reads or writes
};

/// The context's binding of a target: a buffer's id; null: no such target.
std::uint32_t* buffer_binding(Context& c, GLenum target);

/// The buffer of an id; null: none, or this context deleted it.
Buffer* buffer_of(Context& c, ClientName id);

/// Lets go of buffers that others deleted and that this context does not name any more.
void let_go_of_deleted_buffers(Context& c);
/// Whether others deleted buffers since that was last done.
bool buffers_were_deleted(const Context& c);

/// The content that a pointer given while `buffer` was bound stands for, from its offset on. Empty: the buffer is gone,
/// or the offset lies behind its end.
BufferReading buffer_content(Context& c, ClientName buffer, std::uintptr_t offset);

/// The source of an image command (GL_PIXEL_UNPACK_BUFFER) of `bytes` bytes; null with an error if it reaches over the
/// buffer's end. Without a buffer, `pointer` itself. It stays until the next of these two.
const void* unpack_source(Context& c, const void* pointer, std::size_t bytes);
/// The same for a command that writes (GL_PIXEL_PACK_BUFFER).
void* pack_target(Context& c, void* pointer, std::size_t bytes);

}  // namespace wall::client
