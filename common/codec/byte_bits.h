// SPDX-License-Identifier: MIT
// Bits as codec `huffyuv-tiles` lays them out: the first bit lowest, in bytes in order. Inline, for the inner loops.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace wall::codec {

static_assert(std::endian::native == std::endian::little, "bits are written and read in place");

class ByteBitWriter {
public:
    /// Every put() may touch 8 bytes from where it is.
    explicit ByteBitWriter(std::byte* to) : to_(to) {}

    /// `length` up to 56; `bits` has no bit above it.
    void put(std::uint64_t bits, unsigned length) {
        pending_ |= bits << held_;
        held_ += length;
        std::memcpy(to_, &pending_, sizeof pending_);
        to_ += held_ / 8;
        pending_ >>= held_ & 56;
        held_ &= 7;
    }
    /// Returns where the bytes end; the last one is filled with zero bits.
    std::byte* finish() const { return to_ + (held_ > 0 ? 1 : 0); }
    std::byte* at() const { return to_; }
    void move_to(std::byte* to) { to_ = to; }

private:
    std::byte* to_;
    std::uint64_t pending_ = 0;
    unsigned held_ = 0;  ///< below 8
};

class ByteBitReader {
public:
    explicit ByteBitReader(std::span<const std::byte> bytes) : at_(bytes.data()), end_(at_ + bytes.size()) {}

    /// Then at least 56 bits can be taken; beyond the end they are zero.
    void refill() {
        if (end_ - at_ < 8) [[unlikely]]
            return refill_at_end();
        std::uint64_t next;
        std::memcpy(&next, at_, sizeof next);
        bits_ |= next << held_;
        at_ += (63 - held_) / 8;
        held_ |= 56;
    }
    /// The next `count` bits, at most 32, after refill().
    std::uint32_t peek(unsigned count) const {
        return static_cast<std::uint32_t>(bits_ & ((std::uint64_t{1} << count) - 1));
    }
    void skip(unsigned count) {
        bits_ >>= count;
        held_ -= count;
    }
    std::uint32_t take(unsigned count) {
        const auto value = peek(count);
        skip(count);
        return value;
    }
    /// Whether bits beyond the end were taken.
    bool overrun() const { return missing_ * 8 > held_; }
    /// Drops the rest of the byte.
    void align() { skip(held_ % 8); }
    /// Whole bytes that were not taken. Not after an overrun.
    std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_) + held_ / 8 - missing_; }
    /// Whether everything was taken but the last byte's filling.
    bool at_end() const { return !overrun() && bytes_left() == 0; }

private:
    void refill_at_end() {
        while (held_ <= 56) {
            if (at_ < end_) bits_ |= std::to_integer<std::uint64_t>(*at_++) << held_;
            else ++missing_;
            held_ += 8;
        }
    }

    const std::byte* at_;
    const std::byte* end_;
    std::uint64_t bits_ = 0;
    unsigned held_ = 0;
    std::size_t missing_ = 0;  ///< bytes made up
};

}  // namespace wall::codec
