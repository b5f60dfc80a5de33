// SPDX-License-Identifier: MIT
// Buffer objects. The client has all of their content, which pixel transfers and display lists read; a node gets what
// it lacks of it when it draws with it (T3.5). Guarded by the share group's mutex, but for what a reading holds and
// what the program does with a mapping.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "client_lib/objects/changed_pages.h"
#include "client_lib/objects/changed_ranges.h"
#include "client_lib/objects/churn.h"
#include "client_lib/objects/object.h"
#include "common/base/ids.h"
#include "common/glapi/gl_types.h"

namespace wall::client {

/// GL_MIN_MAP_BUFFER_ALIGNMENT: where a buffer's memory begins.
inline constexpr std::size_t kMapAlignment = 64;

/// Of bytes that begin there.
template <class T>
struct MapAllocator {
    using value_type = T;
    MapAllocator() = default;
    template <class U>
    MapAllocator(const MapAllocator<U>&) {}
    T* allocate(std::size_t count) {
        return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(kMapAlignment)));
    }
    void deallocate(T* memory, std::size_t) { ::operator delete(memory, std::align_val_t(kMapAlignment)); }
    bool operator==(const MapAllocator&) const = default;
};

/// The memory of a buffer object. While somebody reads it a change goes into a copy.
struct BufferMemory {
    std::vector<std::byte, MapAllocator<std::byte>> bytes;
    std::atomic<unsigned> readings{0};
};

/// The bytes of a buffer object from some offset on, as they were when the reading began: they stay while it lives,
/// whatever other threads do with the object, but for what the program writes into a mapping.
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

/// A part of a buffer that the program may read or write by a pointer.
struct BufferMapping {
    ByteRange range;
    GLbitfield access = 0;  ///< as of glMapBufferRange

    bool writes() const { return (access & GL_MAP_WRITE_BIT) != 0; }
    /// The buffer may be used meanwhile.
    bool persistent() const { return (access & GL_MAP_PERSISTENT_BIT) != 0; }
    /// The program says what it has written.
    bool tells() const { return (access & GL_MAP_FLUSH_EXPLICIT_BIT) != 0; }
};

class Buffer final : public Object {
public:
    Buffer(ClientName own_id, GLuint own_name) : Object(own_id, own_name) {}

    /// How often anything that can be asked of any buffer of the process has changed: while it stays the same, so do
    /// all answers. Any thread.
    static std::uint64_t changes() { return all_changes.load(std::memory_order_acquire); }

    std::size_t size() const { return memory_->bytes.size(); }
    /// For reading; it is another place after a change.
    const std::byte* data() const { return memory_->bytes.data(); }
    BufferReading read(std::size_t offset = 0) const { return {memory_, offset}; }

    // ---- changes ----
    /// New memory; without `data` it is zeros, here and on the nodes. What was mapped is not any more. Where size and
    /// usage stay, and most of the content, it is only written into.
    void define(const void* data, std::size_t bytes, GLenum usage);
    /// The same for good, with the flags of glBufferStorage.
    void define_storage(const void* data, std::size_t bytes, GLbitfield flags);
    /// `range` lies within it. What is there already does not count as a change.
    void write(ByteRange range, const void* data);
    /// What a pixel command writes into; what was written is told by wrote().
    std::byte* begin_writing();
    void wrote(ByteRange range);

    // ---- mapping ----
    const std::optional<BufferMapping>& mapping() const { return mapping_; }
    /// By which no command may use the buffer.
    bool blocked() const { return mapping_ && !mapping_->persistent(); }
    /// The same of commands that only use a part.
    bool blocked(ByteRange part) const {
        return blocked() && part.begin < mapping_->range.end && mapping_->range.begin < part.end;
    }
    /// What is written into it is seen by whoever uses the buffer afterwards: find_written() comes first.
    bool written_unseen() const {
        return mapping_ && mapping_->persistent() && mapping_->writes() && !mapping_->tells();
    }
    /// It is not mapped; `mapping.range` lies within it and is not empty. Where the range is.
    std::byte* map(const BufferMapping& mapping);
    /// Of the mapping, what the program says that it has written.
    void flush(ByteRange range) { wrote(range); }
    /// It is mapped. What was written into it counts as a change, page by page.
    void unmap();
    /// What was written into the mapping within `range` since it was looked for last counts as a change. False:
    /// nothing was.
    bool find_written(ByteRange range);

    /// Captured by transform feedback: what it holds is on the nodes only from now on.
    void note_drawn();
    /// What a node says that it holds: all of it, as after note_drawn() and what was written since.
    void take_drawn(std::span<const std::byte> content);
    bool is_drawn() const override { return drawn_; }
    void pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer, const std::function<void()>& packed) const override;

    std::uint64_t latest() const override { return stamp_; }
    void pack_changes(std::uint64_t known, wire::PackBuffer& buffer,
                      const std::function<void()>& packed) const override;

    GLenum usage() const { return usage_; }
    /// As glBufferStorage said; of one that may get other memory, what goes with any.
    GLbitfield storage_flags() const { return storage_flags_; }
    bool immutable() const { return immutable_; }
    GLbitfield access = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT;  ///< of the latest mapping
    bool deleted = false;                                    ///< its name is gone
    Churn churn;

private:
    /// Whether `memory_` has what the nodes know of it, and nothing else.
    bool has_all_before() const;
    void leave_to_readers();
    static void count_change() { all_changes.fetch_add(1, std::memory_order_release); }

    static inline std::atomic<std::uint64_t> all_changes{1};
    std::shared_ptr<BufferMemory> memory_ = std::make_shared<BufferMemory>();
    GLenum usage_ = GL_STATIC_DRAW;
    GLbitfield storage_flags_ = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_DYNAMIC_STORAGE_BIT;
    bool immutable_ = false;
    bool drawn_ = false;       ///< `memory_` has only what was written since
    bool zeros_ = false;       ///< nothing was written since it was defined without content
    std::uint64_t stamp_ = 0;  ///< of the latest change; 0: it was never defined
    ChangedRanges changes_;
    std::optional<BufferMapping> mapping_;
    ChangedPages pages_;  ///< of the mapping, if it writes and does not tell
};

}  // namespace wall::client
