// SPDX-License-Identifier: MIT
// A ring of bytes in memory that two processes of one machine share: one writes a data stream into it (frame.h), the
// other reads it, and the kernel copies nothing. Neither waits in it. Whoever finds it full or empty says so in it and
// is told by the other side over the socket that the two have besides: with one byte that there is something, with a
// FrameKind::room that there is room.
//
//   memory := counters, a page of them | bytes, a power of two      (sealed memfd; the writer makes it)
//
// Each side believes the other nothing: counters that cannot be are an error, and whoever reads copies the bytes out
// before looking at them. One thread a side.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/base/result.h"
#include "common/base/unique_fd.h"

namespace wall::wire {

/// Memory that is mapped as long as this lives.
class RingMemory {
public:
    /// In the memory itself. What has been written and read since the beginning, in bytes; and who waits.
    struct Counters {
        alignas(64) std::atomic<std::uint64_t> written;
        std::atomic<std::uint32_t> writer_waits;
        alignas(64) std::atomic<std::uint64_t> read;
        std::atomic<std::uint32_t> reader_waits;
    };
    static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);
    static constexpr std::size_t kPage = 4096;
    static constexpr std::size_t kSmallest = 64 << 10, kLargest = 64 << 20;  ///< bytes of a ring

    /// Of a descriptor whose size is known.
    static Result<RingMemory> map(int descriptor, std::size_t ring_bytes);
    RingMemory(RingMemory&& other) noexcept;
    RingMemory& operator=(RingMemory&& other) noexcept;
    ~RingMemory();

    Counters& counters() const { return *static_cast<Counters*>(memory_); }
    std::byte* bytes() const { return static_cast<std::byte*>(memory_) + kPage; }
    std::size_t size() const { return size_; }

private:
    RingMemory(void* memory, std::size_t size) : memory_(memory), size_(size) {}
    void* memory_ = nullptr;
    std::size_t size_ = 0;  ///< of the ring
};

class RingWriter {
public:
    static constexpr std::size_t kUsual = 2 << 20;  ///< bytes; bench/transport.py

    /// A power of two of bytes. The error says why there is none: the system may forbid it to this process.
    static Result<RingWriter> create(std::size_t bytes = kUsual);

    /// What the reader opens.
    int descriptor() const { return descriptor_.get(); }
    /// It has.
    void close_descriptor() { descriptor_.reset(); }
    /// Writes as much as there is room for; gives how many bytes.
    std::size_t write(std::span<const std::byte> from);
    /// There is no room, and the reader will say when there is. False: there is some by now.
    bool wait_for_room();
    /// The reader waits for what has just been written: it has to be told.
    bool reader_waits();
    /// The reader's counter cannot be: nothing can be written any more.
    bool broken() const { return broken_; }

private:
    RingWriter(UniqueFd descriptor, RingMemory memory)
        : descriptor_(std::move(descriptor)), memory_(std::move(memory)) {}
    std::size_t room();

    UniqueFd descriptor_;
    RingMemory memory_;
    std::uint64_t written_ = 0;
    bool broken_ = false;
};

class RingReader {
public:
    /// Refuses what is no ring that RingWriter makes: the memory must not be taken away from under us.
    static Result<RingReader> open(const UniqueFd& descriptor);

    /// Reads what there is, at most all of `to`; gives how many bytes, or that the ring is broken.
    Result<std::size_t> read(std::span<std::byte> to);
    /// There is nothing, and the writer will say when there is. False: there is something by now.
    bool wait_for_more();
    /// The writer waits, and so much room is there now that it is worth telling.
    bool writer_waits();

private:
    explicit RingReader(RingMemory memory) : memory_(std::move(memory)) {}

    RingMemory memory_;
    std::uint64_t read_ = 0;
};

}  // namespace wall::wire
