// SPDX-License-Identifier: MIT
#include "common/wire/ring.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

namespace wall::wire {
namespace {

constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW;
constexpr std::size_t kPortion = 128 << 10;  // bytes, after which the other side may begin with them

std::string error_text() { return std::strerror(errno); }

bool may_be_a_ring(std::size_t bytes) {
    return std::has_single_bit(bytes) && bytes >= RingMemory::kSmallest && bytes <= RingMemory::kLargest;
}

/// Calls `copy(at, done, n)` for each portion of `bytes` from position `from` on, and `publish(n)` after it.
template <class Copy, class Publish>
void in_portions(std::uint64_t from, std::size_t bytes, std::size_t size, Copy&& copy, Publish&& publish) {
    for (std::size_t done = 0; done < bytes;) {
        const std::size_t at = (from + done) & (size - 1);
        const std::size_t n = std::min({bytes - done, size - at, kPortion});
        copy(at, done, n);
        done += n;
        publish(from + done);
    }
}

}  // namespace

Result<RingMemory> RingMemory::map(int descriptor, std::size_t ring_bytes) {
    void* memory = ::mmap(nullptr, kPage + ring_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    if (memory == MAP_FAILED) return fail("ring: cannot map its memory: " + error_text());
    return RingMemory(memory, ring_bytes);
}

RingMemory::RingMemory(RingMemory&& other) noexcept
    : memory_(std::exchange(other.memory_, nullptr)), size_(std::exchange(other.size_, 0)) {}

RingMemory& RingMemory::operator=(RingMemory&& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(size_, other.size_);
    return *this;
}

RingMemory::~RingMemory() {
    if (memory_) ::munmap(memory_, kPage + size_);
}

// ---- the side that writes ----

Result<RingWriter> RingWriter::create(std::size_t bytes) {
    if (!may_be_a_ring(bytes)) return fail("ring: " + std::to_string(bytes) + " bytes: expected a power of two");
    UniqueFd descriptor(::memfd_create("wallgl-ring", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!descriptor || ::ftruncate(descriptor.get(), static_cast<off_t>(RingMemory::kPage + bytes)) != 0 ||
        ::fcntl(descriptor.get(), F_ADD_SEALS, kSeals) != 0)
        return fail("ring: cannot make its memory: " + error_text());
    auto memory = RingMemory::map(descriptor.get(), bytes);
    if (!memory) return tl::unexpected(memory.error());
    return RingWriter(std::move(descriptor), std::move(*memory));
}

std::size_t RingWriter::room() {
    const std::uint64_t used = written_ - memory_.counters().read.load(std::memory_order_acquire);
    if (used > memory_.size()) broken_ = true;
    return broken_ ? 0 : memory_.size() - static_cast<std::size_t>(used);
}

std::size_t RingWriter::write(std::span<const std::byte> from) {
    const std::size_t bytes = std::min(room(), from.size());
    in_portions(
        written_, bytes, memory_.size(),
        [&](std::size_t at, std::size_t done, std::size_t n) {
            std::memcpy(memory_.bytes() + at, from.data() + done, n);
        },
        [&](std::uint64_t now) { memory_.counters().written.store(now, std::memory_order_release); });
    written_ += bytes;
    return bytes;
}

// Each side says that it waits before it looks once more, and the other one looks whether it does after it has moved
// its counter: of the two, at least one sees the other.
bool RingWriter::wait_for_room() {
    auto& waits = memory_.counters().writer_waits;
    waits.store(1);
    std::atomic_thread_fence(std::memory_order_seq_cst);
    if (room() == 0 && !broken_) return true;
    waits.store(0);
    return false;
}

bool RingWriter::reader_waits() {
    std::atomic_thread_fence(std::memory_order_seq_cst);
    auto& waits = memory_.counters().reader_waits;
    return waits.load(std::memory_order_relaxed) != 0 && waits.exchange(0) != 0;
}

// ---- the side that reads ----

Result<RingReader> RingReader::open(const UniqueFd& descriptor) {
    struct stat about {};
    const int seals = ::fcntl(descriptor.get(), F_GET_SEALS);
    if (seals < 0 || (seals & kSeals) != kSeals || ::fstat(descriptor.get(), &about) != 0)
        return fail("ring: expected memory that is sealed against another size");
    const auto bytes = static_cast<std::size_t>(about.st_size);
    if (bytes <= RingMemory::kPage || !may_be_a_ring(bytes - RingMemory::kPage))
        return fail("ring: memory of " + std::to_string(bytes) + " bytes: expected a page and a power of two");
    auto memory = RingMemory::map(descriptor.get(), bytes - RingMemory::kPage);
    if (!memory) return tl::unexpected(memory.error());
    return RingReader(std::move(*memory));
}

Result<std::size_t> RingReader::read(std::span<std::byte> to) {
    const std::uint64_t waiting = memory_.counters().written.load(std::memory_order_acquire) - read_;
    if (waiting > memory_.size()) return fail("ring: more than it can hold is said to be in it");
    const std::size_t bytes = std::min(static_cast<std::size_t>(waiting), to.size());
    in_portions(
        read_, bytes, memory_.size(),
        [&](std::size_t at, std::size_t done, std::size_t n) {
            std::memcpy(to.data() + done, memory_.bytes() + at, n);
        },
        [&](std::uint64_t now) { memory_.counters().read.store(now, std::memory_order_release); });
    read_ += bytes;
    return bytes;
}

bool RingReader::wait_for_more() {
    auto& waits = memory_.counters().reader_waits;
    waits.store(1);
    std::atomic_thread_fence(std::memory_order_seq_cst);
    if (memory_.counters().written.load(std::memory_order_acquire) == read_) return true;
    waits.store(0);
    return false;
}

bool RingReader::writer_waits() {
    std::atomic_thread_fence(std::memory_order_seq_cst);
    auto& waits = memory_.counters().writer_waits;
    if (waits.load(std::memory_order_relaxed) == 0) return false;
    const std::uint64_t used = memory_.counters().written.load(std::memory_order_acquire) - read_;
    return used <= memory_.size() / 2 && waits.exchange(0) != 0;
}

}  // namespace wall::wire
