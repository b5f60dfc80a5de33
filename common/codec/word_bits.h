// SPDX-License-Identifier: MIT
// Bits as HuffYUV lays them out: in little-endian words of 32 bits, the first bit highest. Inline, for the inner loops.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace wall::codec {

static_assert(std::endian::native == std::endian::little, "bits are written and read in place");

class WordBitWriter {
public:
    /// Every put() may touch 8 bytes from where it is.
    explicit WordBitWriter(std::byte* to) : to_(to) {}

    /// `length` from 1 to 32; `bits` has no bit above it.
    void put(std::uint64_t bits, unsigned length) {
        held_ += length;
        pending_ |= bits << (64 - held_);
        const auto word = static_cast<std::uint32_t>(pending_ >> 32);
        std::memcpy(to_, &word, sizeof word);
        const unsigned full = held_ & 32;  // the word is whole
        to_ += full / 8;
        pending_ <<= full;
        held_ -= full;
    }
    /// Returns where the words end; the last one is filled with zero bits.
    std::byte* finish() {
        if (held_ > 0) put(0, 32 - held_);
        return to_;
    }
    std::byte* at() const { return to_; }
    void move_to(std::byte* to) { to_ = to; }
    unsigned held() const { return held_; }  ///< bits after the last whole word
    std::uint64_t held_bits() const { return held_ > 0 ? pending_ >> (64 - held_) : 0; }

private:
    std::byte* to_;
    std::uint64_t pending_ = 0;  ///< the highest held_ bits
    unsigned held_ = 0;          ///< below 32
};

/// Words in memory that grows. Not for the innermost loop: that takes a copy of writer(), which stays valid for `room`
/// bytes.
class WordBuffer {
public:
    void clear() { writer_ = WordBitWriter(bytes_.data()); }
    /// The writer, with room for that many bytes; as long as nothing else is called.
    WordBitWriter& writer(std::size_t room) {
        const auto used = static_cast<std::size_t>(writer_.at() - bytes_.data());
        if (bytes_.size() - used < room + kSlack) {
            bytes_.resize(bytes_.size() * 2 + room + kSlack);
            writer_.move_to(bytes_.data() + used);
        }
        return writer_;
    }
    /// Puts another's bits behind those that are here.
    void append(const WordBuffer& other) {
        const auto words = static_cast<std::size_t>(other.writer_.at() - other.bytes_.data()) / 4;
        WordBitWriter& to = writer(4 * words + 8);
        for (std::size_t i = 0; i < words; ++i) {
            std::uint32_t word;
            std::memcpy(&word, other.bytes_.data() + 4 * i, sizeof word);
            to.put(word, 32);
        }
        if (other.writer_.held() > 0) to.put(other.writer_.held_bits(), other.writer_.held());
    }
    /// Returns all words; the last one is filled with zero bits.
    std::span<const std::byte> finish() { return {bytes_.data(), writer(8).finish()}; }

private:
    static constexpr std::size_t kSlack = 16;  ///< bytes that put() touches beyond what it needs

    std::vector<std::byte> bytes_;
    WordBitWriter writer_{nullptr};
};

class WordBitReader {
public:
    /// Reads words from `from` on; who uses it makes sure that there are enough, with 8 bytes after them.
    explicit WordBitReader(const std::byte* from) : from_(from) {}

    /// Then at least 32 bits can be taken.
    void refill() {
        std::uint64_t words;
        std::memcpy(&words, from_, sizeof words);
        bits_ |= std::rotl(words, 32) >> held_;
        const unsigned taken = ~held_ & 32;  // one word where fewer than 32 bits are held
        from_ += taken / 8;
        held_ += taken;
    }
    /// The next `count` bits (1 to 32), after refill().
    std::uint32_t peek(unsigned count) const { return static_cast<std::uint32_t>(bits_ >> (64 - count)); }
    void skip(unsigned count) {
        bits_ <<= count;
        held_ -= count;
    }
    std::uint32_t take(unsigned count) {
        refill();
        const auto value = peek(count);
        skip(count);
        return value;
    }
    /// Words taken so far lie before this; at most 63 bits of them are still held.
    const std::byte* at() const { return from_ - held_ / 32 * 4; }

private:
    const std::byte* from_;
    std::uint64_t bits_ = 0;
    unsigned held_ = 0;
};

}  // namespace wall::codec
