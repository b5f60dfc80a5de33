// SPDX-License-Identifier: MIT
// A Block in a node's batch while its commands are packed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/wire/pack_buffer.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {

/// Packs the head of a Block for these layers; its counts are filled in by end_block().
struct OpenBlock {
    std::size_t counts;    ///< where they stand among the operands
    wire::PackMark start;  ///< of its commands
};
inline OpenBlock begin_block(wire::PackBuffer& buffer, std::uint64_t slots) {
    const std::size_t operands = buffer.operand_bytes();
    glapi::pack::Block(buffer, static_cast<std::uint32_t>(slots), static_cast<std::uint32_t>(slots >> 32), 0, 0);
    return {operands + 2 * sizeof(std::uint32_t), buffer.mark()};
}
inline void end_block(wire::PackBuffer& buffer, const OpenBlock& block) {
    const auto end = buffer.mark();
    const std::uint32_t counts[2] = {static_cast<std::uint32_t>(end.commands - block.start.commands),
                                     static_cast<std::uint32_t>(end.operand_bytes - block.start.operand_bytes)};
    std::memcpy(buffer.operand_at(block.counts), counts, sizeof counts);
}

}  // namespace wall::client
