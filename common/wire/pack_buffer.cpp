// SPDX-License-Identifier: MIT
#include "common/wire/pack_buffer.h"

#include <algorithm>

#include "common/wire/padding.h"

namespace wall::wire {

PackBuffer::PackBuffer(std::size_t operand_bytes) { grow(operand_bytes / 4, operand_bytes); }

void PackBuffer::grow(std::size_t opcodes, std::size_t operand_bytes) {
    const std::size_t used_opcodes = commands(), used_operands = this->operand_bytes();
    const std::size_t room_opcodes = padded4(std::max(used_opcodes * 2, used_opcodes + opcodes));
    const std::size_t room_operands = padded4(std::max(used_operands * 2, used_operands + operand_bytes));
    auto memory = std::make_unique_for_overwrite<std::byte[]>(room_opcodes + room_operands);
    std::byte* middle = memory.get() + room_opcodes;
    if (memory_) std::memcpy(middle - used_opcodes, opcodes_, used_opcodes + used_operands);
    memory_ = std::move(memory);
    capacity_ = room_opcodes + room_operands;
    middle_ = middle;
    opcodes_ = middle - used_opcodes;
    operands_ = middle + used_operands;
}

void PackBuffer::append(const PackBuffer& from, PackMark first, PackMark last) {
    const std::size_t commands = last.commands - first.commands;
    const std::size_t bytes = last.operand_bytes - first.operand_bytes;
    if (static_cast<std::size_t>(opcodes_ - base()) < commands ||
        static_cast<std::size_t>(end_of_memory() - operands_) < bytes)
        grow(commands, bytes);
    opcodes_ -= commands;
    std::memcpy(opcodes_, from.middle_ - last.commands, commands);
    std::memcpy(operands_, from.middle_ + first.operand_bytes, bytes);
    operands_ += bytes;
}

}  // namespace wall::wire
