// SPDX-License-Identifier: MIT
// Buffer objects. The client has all of their content, which pixel transfers and display lists read; a node gets what
// it lacks of it when it draws with it (T3.5). Guarded by the share group's mutex, but for what a reading holds.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "client_lib/objects/changed_ranges.h"
#include "client_lib/objects/churn.h"
#include "client_lib/objects/object.h"
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

/// What one command to a node carries at most.
inline constexpr std::size_t kLargestBufferCommand = std::size_t{4} << 20;

class Buffer : public Object {
public:
    Buffer(ClientName own_id, GLuint own_name) : Object(own_id, own_name) {}

    std::size_t size() const { return memory_->bytes.size(); }
    /// For reading; it is another place after a change.
    const std::byte* data() const { return memory_->bytes.data(); }
    BufferReading read(std::size_t offset = 0) const { return {memory_, offset}; }

    // ---- changes ----
    /// New memory; without `data` its content is undefined.
    void define(const void* data, std::size_t bytes, GLenum usage);
    /// `range` lies within it.
    void write(ByteRange range, const void* data);
    /// What a mapping or a pixel command writes into; what was written is told by wrote().
    std::byte* begin_writing();
    void wrote(ByteRange range);

    std::uint64_t latest() const override { return stamp_; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;

    GLenum usage() const { return usage_; }
    GLenum access = GL_READ_WRITE;  ///< of the latest glMapBuffer
    bool mapped = false;
    bool deleted = false;  ///< its name is gone
    Churn churn;

private:
    void leave_to_readers();

    std::shared_ptr<BufferMemory> memory_ = std::make_shared<BufferMemory>();
    GLenum usage_ = GL_STATIC_DRAW;
    std::uint64_t stamp_ = 0;  ///< of the latest change; 0: it was never defined
    ChangedRanges changes_;
};

}  // namespace wall::client
