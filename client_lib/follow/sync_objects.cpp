// SPDX-License-Identifier: MIT
#include "client_lib/follow/sync_objects.h"

namespace wall::client {
namespace {

constexpr std::uint32_t kMaxCount = 1u << 30;  // of a semaphore

}  // namespace

GLenum SyncObjects::barrier_create(std::uint32_t name, std::uint32_t count) {
    if (name == 0 || count == 0 || count > members_) return GL_INVALID_VALUE;
    const auto known = barriers_.find(name);
    if (known != barriers_.end()) return known->second == count ? GL_NO_ERROR : GL_INVALID_OPERATION;
    if (barriers_.size() >= kMost) return GL_OUT_OF_MEMORY;
    barriers_[name] = count;
    return GL_NO_ERROR;
}

GLenum SyncObjects::semaphore_create(std::uint32_t name, std::uint32_t count) {
    if (name == 0 || count > kMaxCount) return GL_INVALID_VALUE;
    const auto known = semaphores_.find(name);
    if (known != semaphores_.end()) return known->second.count == count ? GL_NO_ERROR : GL_INVALID_OPERATION;
    if (semaphores_.size() >= kMost) return GL_OUT_OF_MEMORY;
    semaphores_[name].count = count;
    return GL_NO_ERROR;
}

GLenum SyncObjects::semaphore_p(std::uint32_t name) {
    const auto known = semaphores_.find(name);
    if (known == semaphores_.end()) return GL_INVALID_OPERATION;
    const auto alone_forever = members_ == 1 && known->second.count + std::int64_t{known->second.moved} <= 0;
    if (alone_forever) return GL_INVALID_OPERATION;
    --known->second.moved;
    return GL_NO_ERROR;
}

GLenum SyncObjects::semaphore_v(std::uint32_t name) {
    const auto known = semaphores_.find(name);
    if (known == semaphores_.end()) return GL_INVALID_OPERATION;
    ++known->second.moved;
    return GL_NO_ERROR;
}

}  // namespace wall::client
