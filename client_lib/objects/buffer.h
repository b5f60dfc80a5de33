// SPDX-License-Identifier: MIT
// Buffer objects: their content lives in the client, whose vertex arrays and pixel transfers read it.
// Guarded by the share group's mutex, but for what a reading holds.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/base/ids.h"
#include "common/glapi/gl_types.h"

namespace wall::client {

/// The memory of a buffer object. While somebody reads it a change goes into a copy.
struct BufferMemory {
    std::vector<std::byte> bytes;
    std::atomic<unsigned> readings{0};
};

/// The bytes of a buffer object from some offset on, as they were when the reading began: they stay while it lives,
/// whatever other threads do with the object.
class BufferReading {
public:
    BufferReading() = default;
    BufferReading(std::shared_ptr<BufferMemory> memory, std::size_t offset)
        : memory_(std::move(memory)), bytes_(std::span(memory_->bytes).subspan(offset)) {
        memory_->readings.fetch_add(1, std::memory_order_relaxed);
    }
    ~BufferReading() {
        if (memory_) memory_->readings.fetch_sub(1, std::memory_order_release);
    }
    BufferReading(BufferReading&& other) noexcept
        : memory_(std::move(other.memory_)), bytes_(std::exchange(other.bytes_, {})) {}
    BufferReading& operator=(BufferReading&& other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(bytes_, other.bytes_);
        return *this;
    }

    std::span<std::byte> bytes() const { return bytes_; }

private:
    std::shared_ptr<BufferMemory> memory_;
    std::span<std::byte> bytes_;
};

struct Buffer {
    Buffer(ClientName own_id, GLuint own_name) : id(own_id), name(own_name) {}
    const ClientName id;  ///< in state elements and client arrays
    const GLuint name;    ///< the application's

    std::size_t size() const { return memory->bytes.size(); }
    std::byte* data() { return memory->bytes.data(); }
    BufferReading read(std::size_t offset = 0) const { return {memory, offset}; }
    /// Call before its content is changed.
    void leave_to_readers() {
        if (memory->readings.load(std::memory_order_acquire) == 0) return;
        auto copy = std::make_shared<BufferMemory>();
        copy->bytes = memory->bytes;
        memory = std::move(copy);
    }
    /// Call before its content is replaced: the old one need not be kept.
    void leave_all_to_readers() {
        if (memory->readings.load(std::memory_order_acquire) != 0) memory = std::make_shared<BufferMemory>();
    }

    std::shared_ptr<BufferMemory> memory = std::make_shared<BufferMemory>();
    GLenum usage = GL_STATIC_DRAW;
    GLenum access = GL_READ_WRITE;  ///< of the latest glMapBuffer
    bool mapped = false;
    bool deleted = false;     ///< its name is gone
    std::uint64_t stamp = 0;  ///< of the latest change
};

}  // namespace wall::client
