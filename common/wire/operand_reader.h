// SPDX-License-Identifier: MIT
// Reads the operands of a packed batch (pack_buffer.h): bounded, with a sticky failure, so that a handler may read all
// it wants and check once. Values are little endian and 4-byte aligned. Any thread; the bytes must stay while used.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "common/wire/padding.h"

namespace wall::wire {

static_assert(std::endian::native == std::endian::little, "the stream is read in place");

template <class T>
T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

class OperandReader {
public:
    explicit OperandReader(std::span<const std::byte> operands) : at_(operands.data()), end_(at_ + operands.size()) {}

    /// False once anything was read beyond the end; then every read gives zero or nothing.
    bool ok() const { return ok_; }
    std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }

    /// The next `bytes` bytes (no padding); empty after a failure.
    std::span<const std::byte> raw(std::size_t bytes) {
        if (remaining() < bytes) [[unlikely]] {
            fail();
            return {};
        }
        const std::byte* from = at_;
        at_ += bytes;
        return {from, bytes};
    }
    /// The next value; zero after a failure.
    template <class T>
    T get() {
        const auto from = raw(sizeof(T));
        return ok_ ? load<T>(from.data()) : T{};
    }
    /// A bytes operand: u32 count, content, padding to 4.
    std::span<const std::byte> bytes() {
        const std::size_t count = get<std::uint32_t>();
        return raw(padded4(count)).first(ok_ ? count : 0);
    }
    void fail() {
        ok_ = false;
        at_ = end_;
    }

private:
    const std::byte* at_;
    const std::byte* end_;
    bool ok_ = true;
};

}  // namespace wall::wire
