// SPDX-License-Identifier: MIT
// Sync objects (OpenGL 3.2, 5.3). A fence is signaled when all nodes have done what the process sent them before it.
// Making one costs no round trip; the first command that asks for its state sends what is packed.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>

#include "client_lib/context/context.h"
#include "client_lib/context/fence_object.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

std::shared_ptr<FenceObject> find(Context& c, GLsync handle) {
    std::lock_guard lock(c.share().mutex);
    const auto found = c.share().fences.find(handle);
    return found == c.share().fences.end() ? nullptr : found->second;
}

bool is_signaled(FenceObject& sync) {
    if (!sync.signaled && sync.fence.done()) sync.signaled = true;
    return sync.signaled;
}

}  // namespace

GLsync FenceSync(Context& c, GLenum condition, GLbitfield flags) {
    if (condition != GL_SYNC_GPU_COMMANDS_COMPLETE) return c.error(GL_INVALID_ENUM), nullptr;
    if (flags != 0) return c.error(GL_INVALID_VALUE), nullptr;
    c.flush_block();
    auto made = std::make_shared<FenceObject>();
    made->fence = c.session().fence();
    const auto handle = reinterpret_cast<GLsync>(static_cast<std::uintptr_t>(next_object_id().value));
    std::lock_guard lock(c.share().mutex);
    c.share().fences[handle] = std::move(made);
    return handle;
}

GLboolean IsSync(Context& c, GLsync handle) { return find(c, handle) != nullptr; }

void DeleteSync(Context& c, GLsync handle) {
    if (!handle) return;
    std::shared_ptr<FenceObject> gone;  // what waits for it in another thread keeps it
    std::lock_guard lock(c.share().mutex);
    const auto found = c.share().fences.find(handle);
    if (found == c.share().fences.end()) return c.error(GL_INVALID_VALUE);
    gone = std::move(found->second);
    c.share().fences.erase(found);
}

GLenum ClientWaitSync(Context& c, GLsync handle, GLbitfield flags, GLuint64 timeout) {
    const auto sync = find(c, handle);
    if (!sync || (flags & ~GLbitfield{GL_SYNC_FLUSH_COMMANDS_BIT}) != 0)
        return c.error(GL_INVALID_VALUE), GLenum{GL_WAIT_FAILED};
    if (!is_signaled(*sync)) c.flush(false);  // also without the bit: a program that polls would wait for ever
    // What is signaled before it begins to wait counts as signaled when the call was made: a test without time to wait
    // never says "satisfied".
    if (is_signaled(*sync)) return GL_ALREADY_SIGNALED;
    if (timeout == 0) return GL_TIMEOUT_EXPIRED;
    const auto limit =
        std::min<GLuint64>(timeout, static_cast<GLuint64>(std::chrono::nanoseconds(Fence::kLongestWait).count()));
    const auto deadline = Fence::Clock::now() + std::chrono::nanoseconds(limit);
    if (!c.session().wait_for(sync->fence, deadline, "glClientWaitSync")) return GL_TIMEOUT_EXPIRED;
    sync->signaled = true;
    return GL_CONDITION_SATISFIED;
}

// A node executes a process's commands in their order, those of all contexts.
void WaitSync(Context& c, GLsync handle, GLbitfield flags, GLuint64 timeout) {
    if (!find(c, handle) || flags != 0 || timeout != GL_TIMEOUT_IGNORED) c.error(GL_INVALID_VALUE);
}

void GetSynciv(Context& c, GLsync handle, GLenum pname, GLsizei count, GLsizei* length, GLint* values) {
    const auto sync = find(c, handle);
    if (!sync || count < 0) return c.error(GL_INVALID_VALUE);
    GLint value = 0;
    switch (pname) {
        case GL_OBJECT_TYPE: value = GL_SYNC_FENCE; break;
        case GL_SYNC_CONDITION: value = GL_SYNC_GPU_COMMANDS_COMPLETE; break;
        case GL_SYNC_FLAGS: break;
        case GL_SYNC_STATUS:
            if (!is_signaled(*sync)) c.flush(false);
            value = is_signaled(*sync) ? GL_SIGNALED : GL_UNSIGNALED;
            break;
        default: return c.error(GL_INVALID_ENUM);
    }
    if (count > 0 && values) *values = value;
    if (length) *length = 1;
}

}  // namespace wall::client::api
