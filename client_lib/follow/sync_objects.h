// SPDX-License-Identifier: MIT
// The barriers and semaphores (GL_CR_synchronization) that this process has created: the errors of the calls, and what
// a node must be told that comes later. Who waits for whom is decided on the nodes. Pure; whoever owns it guards it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "common/glapi/gl_types.h"

namespace wall::client {

struct SyncSemaphore {
    std::uint32_t count = 0;  ///< at first
    std::int32_t moved = 0;   ///< what this process has added and taken since
};

class SyncObjects {
public:
    static constexpr std::size_t kMost = 1024;  ///< barriers, semaphores: each

    explicit SyncObjects(std::uint32_t members) : members_(members) {}

    const std::map<std::uint32_t, std::uint32_t>& barriers() const { return barriers_; }  ///< name -> count
    const std::map<std::uint32_t, SyncSemaphore>& semaphores() const { return semaphores_; }

    // Each gives the call's OpenGL error, GL_NO_ERROR if it is good.
    GLenum barrier_create(std::uint32_t name, std::uint32_t count);
    GLenum barrier_destroy(std::uint32_t name) {
        return barriers_.erase(name) != 0 ? GL_NO_ERROR : GL_INVALID_OPERATION;
    }
    GLenum barrier_exec(std::uint32_t name) const {
        return barriers_.contains(name) ? GL_NO_ERROR : GL_INVALID_OPERATION;
    }
    GLenum semaphore_create(std::uint32_t name, std::uint32_t count);
    GLenum semaphore_destroy(std::uint32_t name) {
        return semaphores_.erase(name) != 0 ? GL_NO_ERROR : GL_INVALID_OPERATION;
    }
    GLenum semaphore_p(std::uint32_t name);
    GLenum semaphore_v(std::uint32_t name);

private:
    std::uint32_t members_;
    std::map<std::uint32_t, std::uint32_t> barriers_;
    std::map<std::uint32_t, SyncSemaphore> semaphores_;
};

}  // namespace wall::client
