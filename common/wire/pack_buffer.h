// SPDX-License-Identifier: MIT
// A growing batch of packed commands (W3.1): one-byte opcodes written downwards, 4-byte aligned operands upwards, in
// one allocation, so that one pointer pair describes it and one header sends it.
//
//     |      free |  op n ... op 1 op 0 | operands 0, 1, ... n |     free |
//     begin       ^ opcodes_            ^ middle_              ^ operands_  end
//
// One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>

namespace wall::wire {

/// Where the next opcode and operand would go; also names a place to copy from. Valid until the buffer is cleared.
struct PackMark {
    std::size_t commands = 0;       ///< opcodes so far
    std::size_t operand_bytes = 0;  ///< operands so far
};

class PackBuffer {
public:
    /// Room for `operand_bytes` of operands and a quarter as many opcodes before the first growth.
    explicit PackBuffer(std::size_t operand_bytes = 64 << 10);

    /// Appends an opcode with `bytes` of operands (a multiple of 4) and returns where the operands go.
    std::byte* append(std::uint8_t opcode, std::size_t bytes) {
        if (opcodes_ == base() || static_cast<std::size_t>(end_of_memory() - operands_) < bytes) [[unlikely]]
            grow(1, bytes);
        *--opcodes_ = static_cast<std::byte>(opcode);
        std::byte* at = operands_;
        operands_ += bytes;
        return at;
    }

    /// Appends the commands of `from` between two of its marks.
    void append(const PackBuffer& from, PackMark first, PackMark last);

    PackMark mark() const { return {commands(), operand_bytes()}; }
    std::size_t commands() const { return static_cast<std::size_t>(middle_ - opcodes_); }
    std::size_t operand_bytes() const { return static_cast<std::size_t>(operands_ - middle_); }
    std::size_t bytes() const { return commands() + operand_bytes(); }
    std::size_t capacity() const { return capacity_; }  ///< bytes
    bool empty() const { return opcodes_ == middle_; }
    void clear() { opcodes_ = operands_ = middle_; }

    /// Opcodes in memory order, i.e. last first.
    std::span<const std::byte> opcodes() const { return {opcodes_, commands()}; }
    std::span<const std::byte> operands() const { return {middle_, operand_bytes()}; }
    std::byte opcode_at(std::size_t command) const { return middle_[-1 - static_cast<std::ptrdiff_t>(command)]; }
    const std::byte* operand_at(std::size_t offset) const { return middle_ + offset; }
    std::byte* operand_at(std::size_t offset) { return middle_ + offset; }

    /// Makes room for at least so much more.
    void grow(std::size_t opcodes, std::size_t operand_bytes);

protected:
    const std::byte* base() const { return memory_.get(); }
    const std::byte* end_of_memory() const { return memory_.get() + capacity_; }

    std::unique_ptr<std::byte[]> memory_;
    std::size_t capacity_ = 0;
    std::byte* middle_ = nullptr;
    std::byte* opcodes_ = nullptr;
    std::byte* operands_ = nullptr;
};

}  // namespace wall::wire
