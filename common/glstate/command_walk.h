// SPDX-License-Identifier: MIT
// Goes over a batch's commands without executing them: for who passes a stream on, or wants to know what is in it.
// Bounded; what is within a block is not looked at. Pure; the bytes must stay as long as it is used.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "common/base/result.h"
#include "common/glstate/elements.h"
#include "common/wire/operand_reader.h"
#include "gen/glapi/wire.gen.h"

namespace wall::glstate {

/// Of proto/gl/wire.toml.
struct Command {
    glapi::Op op{};
    std::span<const std::byte> operands;  ///< with the padding behind a bytes operand
    // What follows a Block.
    std::span<const std::byte> block_opcodes;  ///< last first
    std::span<const std::byte> block_operands;

    /// The operand word at that place; there is one.
    std::uint32_t word(std::size_t place) const { return wire::load<std::uint32_t>(operands.data() + 4 * place); }
};

class CommandWalk {
public:
    CommandWalk(std::span<const std::byte> opcodes_last_first, std::span<const std::byte> operands)
        : next_(opcodes_last_first.data() + opcodes_last_first.size()),
          left_(opcodes_last_first.size()),
          operands_(operands) {}

    /// The next command, nothing at the end, or why this is no batch.
    Result<std::optional<Command>> next() {
        if (left_ == 0) {
            if (operands_.remaining() != 0) return fail("operands left over");
            return std::optional<Command>();
        }
        --left_;
        const auto op = std::to_integer<std::size_t>(*--next_);
        if (op >= glapi::kOpCount) return fail("unknown opcode " + std::to_string(op));
        Command out{.op = static_cast<glapi::Op>(op), .operands = {}, .block_opcodes = {}, .block_operands = {}};
        wire::OperandReader size = operands_;
        std::size_t bytes = glapi::kOpFixedBytes[op];
        const auto fixed = size.raw(bytes);
        if (size.ok() && glapi::kOpHasBytes[op])
            bytes += wire::padded4(wire::load<std::uint32_t>(fixed.data() + fixed.size() - 4));
        if (size.ok() && out.op == glapi::Op::State) {
            const auto value = element_bytes(wire::load<std::uint32_t>(fixed.data()));
            if (value == 0) return fail("State: no such element");
            bytes += value;
        }
        out.operands = operands_.raw(bytes);
        if (operands_.ok() && out.op == glapi::Op::Block) {
            const std::size_t commands = out.word(2);
            out.block_operands = operands_.raw(out.word(3));
            if (commands > left_) return fail("Block: reaches over the batch's end");
            next_ -= commands;
            left_ -= commands;
            out.block_opcodes = {next_, commands};
        }
        if (!operands_.ok()) return fail(std::string(glapi::kOpNames[op]) + ": bad operands");
        return std::optional(out);
    }

private:
    const std::byte* next_;  ///< one above the next opcode
    std::size_t left_;       ///< opcodes
    wire::OperandReader operands_;
};

}  // namespace wall::glstate
