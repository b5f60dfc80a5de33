// SPDX-License-Identifier: MIT
// Which buffer objects a context has at its targets and in its arrays, and reading them, for the commands that take "a
// pointer, or an offset if a buffer is bound". A context keeps what it has: when another context of the group deletes
// an object, only its name is gone (OpenGL 2.1, appendix D). Application threads.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "client_lib/context/buffer_use.h"
#include "client_lib/context/context.h"

namespace wall::client {

/// What is bound to a target: a buffer's id, 0: none. Nothing: no such target.
std::optional<ClientName> bound_buffer_id(const Context& c, GLenum target);
/// `target` is one. 0 unbinds.
void bind_buffer(Context& c, GLenum target, ClientName id);

/// The buffer of an id; null: none, or this context deleted it.
Buffer* buffer_of(Context& c, ClientName id);

/// This context has deleted the buffer's name: it leaves the bindings and the arrays that are set now. What another
/// vertex array object or glPushClientAttrib keeps of it stays (OpenGL 3.0, 2.9 and D.1). No mutex is held.
void let_go_of_own_buffer(Context& c, std::shared_ptr<Buffer> buffer);
/// This context names the buffer, which is deleted, no more. With the last context's use of it the nodes are told.
/// No mutex is held.
void let_go_of_buffer(Context& c, std::shared_ptr<Buffer> buffer);
/// Before a context is gone.
void let_go_of_all_buffers(Context& c);
/// Before a buffer's content changes: what was drawn from it and is kept is sent, and the latest pixel command does
/// not read it any more. No mutex is held.
void before_writing(Context& c, const Buffer& buffer);
/// Lets go of buffers that others deleted and that this context does not name any more.
void let_go_of_deleted_buffers(Context& c);
/// Whether that should be done now, at a command that may have taken a name of one away.
bool deleted_buffers_are_due(Context& c);
/// Whether others deleted buffers since that was last done.
bool buffers_were_deleted(const Context& c);

/// The content that a pointer given while `buffer` was bound stands for, from its offset on. Empty: the buffer is gone,
/// or the offset lies behind its end.
BufferReading buffer_content(Context& c, ClientName buffer, std::uintptr_t offset);

/// The source of an image command (GL_PIXEL_UNPACK_BUFFER) of `bytes` bytes; null with an error if it reaches over the
/// buffer's end. Without a buffer, `pointer` itself. It stays until the next of these two.
const void* unpack_source(Context& c, const void* pointer, std::size_t bytes);
/// Where a command that writes pixels puts them: memory of the program or of a buffer. That the buffer has changed is
/// noted when this goes.
class PackTarget {
public:
    explicit PackTarget(void* memory) : at_(memory) {}
    /// `range` lies within the buffer, whose share group's mutex is held.
    PackTarget(ShareGroup& share, std::shared_ptr<Buffer> buffer, ByteRange range);
    ~PackTarget();
    PackTarget(const PackTarget&) = delete;
    /// Null: nowhere.
    void* get() const { return at_; }
    explicit operator bool() const { return at_ != nullptr; }

private:
    void* at_ = nullptr;
    ShareGroup* share_ = nullptr;
    std::shared_ptr<Buffer> buffer_;
    BufferReading reading_;  ///< the memory stays
    ByteRange range_;
};

/// The same as unpack_source() for a command that writes (GL_PIXEL_PACK_BUFFER).
PackTarget pack_target(Context& c, void* pointer, std::size_t bytes);

}  // namespace wall::client
