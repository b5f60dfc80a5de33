// SPDX-License-Identifier: MIT
// A display list while it is compiled: an append-only stream of recorded commands.
//
//   list   := record*
//   record := command:u16 words:u16 [words:u32, if the former is kMany] payload (words * 4 bytes)
//
// Scalars take 4 bytes (doubles 8), arrays a count and their values, padded to 4. One thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "common/wire/padding.h"

namespace wall::glapi {

/// An array argument of a recorded command.
template <class T>
struct RecordedArray {
    const T* values;
    std::uint32_t count;
};
template <class T>
RecordedArray<T> recorded_array(const T* values, std::ptrdiff_t count) {
    return {values, values && count > 0 ? static_cast<std::uint32_t>(count) : 0};
}

class ListRecorder {
public:
    bool execute = false;  ///< GL_COMPILE_AND_EXECUTE

    /// Appends a command with scalar and array arguments.
    template <class... Args>
    void record(std::uint16_t command, const Args&... args) {
        [[maybe_unused]] std::byte* at = append(command, (std::size_t{0} + ... + size_of(args)));
        ((at = put(at, args)), ...);
    }
    /// Appends a command with `bytes` of payload (zeroed, rounded up to 4), to be filled by the caller at once.
    std::byte* append(std::uint16_t command, std::size_t bytes) {
        const std::size_t words = wire::padded4(bytes) / 4, start = stream_.size(), head = words < kMany ? 4 : 8;
        stream_.resize(start + head + words * 4);
        const std::uint16_t header[2] = {command, static_cast<std::uint16_t>(words < kMany ? words : kMany)};
        std::memcpy(stream_.data() + start, header, sizeof header);
        if (words >= kMany) {
            const auto many = static_cast<std::uint32_t>(words);
            std::memcpy(stream_.data() + start + 4, &many, sizeof many);
        }
        return stream_.data() + start + head;
    }

    std::span<const std::byte> stream() const { return stream_; }
    std::vector<std::byte> take() { return std::move(stream_); }
    void clear() { stream_.clear(); }

    static constexpr std::uint16_t kMany = 0xffff;

private:
    template <class T>
    static std::size_t size_of(const T&) {
        return sizeof(T) <= 4 ? 4 : 8;
    }
    template <class T>
    static std::size_t size_of(const RecordedArray<T>& a) {
        return 4 + wire::padded4(a.count * sizeof(T));
    }
    template <class T>
    static std::byte* put(std::byte* at, const T& value) {
        static_assert(std::is_arithmetic_v<T>);
        std::memcpy(at, &value, sizeof value);
        return at + size_of(value);
    }
    template <class T>
    static std::byte* put(std::byte* at, const RecordedArray<T>& a) {
        std::memcpy(at, &a.count, 4);
        if (a.count) std::memcpy(at + 4, a.values, a.count * sizeof(T));
        return at + size_of(a);
    }

    std::vector<std::byte> stream_;
};

/// One recorded command.
struct Recorded {
    std::uint16_t command = 0;
    std::span<const std::byte> payload;
};

/// Calls `f(Recorded)` for each command of a list, in order, as long as it returns true.
template <class F>
void for_each_record(std::span<const std::byte> list, F&& f) {
    std::size_t at = 0;
    while (at < list.size()) {
        std::uint16_t header[2];
        std::memcpy(header, list.data() + at, sizeof header);
        at += 4;
        std::uint32_t words = header[1];
        if (words == ListRecorder::kMany) {
            std::memcpy(&words, list.data() + at, 4);
            at += 4;
        }
        if (!f(Recorded{header[0], list.subspan(at, std::size_t{words} * 4)})) return;
        at += std::size_t{words} * 4;
    }
}

/// Reads a payload back in the order in which it was recorded. Trusts it: lists never leave the process.
class RecordReader {
public:
    explicit RecordReader(std::span<const std::byte> payload) : at_(payload.data()) {}

    template <class T>
    T get() {
        T value;
        std::memcpy(&value, at_, sizeof value);
        at_ += sizeof(T) <= 4 ? 4 : 8;
        return value;
    }
    /// Valid while the reader and the list live. One array of doubles (16 at most) can be read.
    template <class T>
    const T* array() {
        const auto count = get<std::uint32_t>();
        const std::byte* from = at_;
        at_ += wire::padded4(count * sizeof(T));
        if constexpr (alignof(T) > 4) {
            std::memcpy(aligned_, from, std::min(sizeof aligned_, count * sizeof(T)));
            return reinterpret_cast<const T*>(aligned_);
        } else {
            return reinterpret_cast<const T*>(from);
        }
    }

private:
    const std::byte* at_;
    alignas(8) std::byte aligned_[16 * sizeof(double)] = {};
};

}  // namespace wall::glapi
