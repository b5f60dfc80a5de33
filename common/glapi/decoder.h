// SPDX-License-Identifier: MIT
// Decodes packed batches: walks the opcodes, checks the operands' bounds, calls a handler H. A bad batch is refused at
// its first bad command, with the reason; what came before it has been executed. One thread; H's.
//
// H derives from glapi::Handler and offers
//   - one member per command of proto/gl/wire.toml: `void Clear(uint32_t mask)`, ... (bytes operand: std::span<const
//   std::byte>);
//   - `uint32_t state_bytes(uint32_t id)`, 0 = no such element (glstate::element_bytes), and `bool State(uint32_t id,
//      std::span<const std::byte> value)`, false = bad value;
//   - `uint64_t begin_block(uint64_t tiles, size_t bytes)`: the tiles to run the block for (all asked for, or fewer);
//   `bytes` of
//      commands it takes in the batch,
//     `void begin_tile(unsigned slot)`, `void end_block()`.
// A member that cannot go on calls `refuse("why")`.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "common/base/result.h"
#include "common/wire/operand_reader.h"
#include "gen/glapi/decode.gen.h"

namespace wall::glapi {

/// The refusal of a handler: sticky, the first reason stays.
class Handler {
public:
    void refuse(std::string reason) {
        if (!refused_) reason_ = std::move(reason);
        refused_ = true;
    }
    bool refused() const { return refused_; }
    const std::string& reason() const { return reason_; }

private:
    bool refused_ = false;
    std::string reason_;
};

namespace detail {

/// Opcodes are stored last first, so the walk goes downwards.
struct OpcodeWalk {
    const std::byte* next;  ///< one above the next opcode
    const std::byte* end;   ///< the last opcode
    explicit OpcodeWalk(std::span<const std::byte> opcodes)
        : next(opcodes.data() + opcodes.size()), end(opcodes.data()) {}
    std::size_t remaining() const { return static_cast<std::size_t>(next - end); }
    std::size_t take() { return std::to_integer<std::size_t>(*--next); }
};

/// A Block command itself: its opcode and four words.
inline constexpr std::size_t kBlockBytes = 1 + 4 * sizeof(std::uint32_t);

inline bool inside_block(OpGroup group) { return group == OpGroup::geometry || group == OpGroup::draw; }

template <class H>
tl::unexpected<Error> refusal(std::size_t op, const H& h) {
    const std::string name = op < kOpCount ? kOpNames[op] : "opcode " + std::to_string(op);
    return fail(name + ": " + (h.refused() ? h.reason() : std::string("bad operands")));
}

/// Commands of groups geometry and draw only, consuming the operands exactly. `nested`: within a run, so no RunCall.
template <class H>
Result<void> run_drawing(OpcodeWalk ops, wire::OperandReader operands, H& h, bool nested) {
    using Table = DecodeTable<H>;
    while (ops.remaining() != 0) {
        const std::size_t op = ops.take();
        if (op >= kOpCount || !inside_block(kOpGroups[op]))
            return fail("a block may not hold " + std::string(op < kOpCount ? kOpNames[op] : "an unknown opcode"));
        if (nested && static_cast<Op>(op) == Op::RunCall) return fail("a run may not call a run");
        if (!Table::rows[op].run(h, operands)) return refusal(op, h);
    }
    if (operands.remaining() != 0) return fail("operands left over");
    return {};
}

template <class H>
Result<void> run_block(OpcodeWalk& ops, wire::OperandReader& operands, H& h) {
    const std::uint64_t low = operands.get<std::uint32_t>(), high = operands.get<std::uint32_t>();
    const std::size_t commands = operands.get<std::uint32_t>(), bytes = operands.get<std::uint32_t>();
    const auto content = operands.raw(bytes);
    if (!operands.ok() || ops.remaining() < commands) return fail("Block: reaches over the batch's end");
    const OpcodeWalk body(std::span(ops.next - commands, commands));
    ops.next -= commands;
    std::uint64_t tiles = h.begin_block(low | high << 32, kBlockBytes + commands + bytes) & (low | high << 32);
    for (; tiles != 0 && !h.refused(); tiles &= tiles - 1) {
        h.begin_tile(static_cast<unsigned>(std::countr_zero(tiles)));
        if (auto done = run_drawing(body, wire::OperandReader(content), h, false); !done) return done;
    }
    h.end_block();
    if (h.refused()) return refusal(static_cast<std::size_t>(Op::Block), h);
    return {};
}

}  // namespace detail

/// Runs a batch (wire::split_batch gives the two spans).
template <class H>
Result<void> decode(std::span<const std::byte> opcodes_last_first, std::span<const std::byte> operands, H& h) {
    detail::OpcodeWalk ops(opcodes_last_first);
    wire::OperandReader in(operands);
    while (ops.remaining() != 0) {
        const std::size_t op = ops.take();
        if (op >= kOpCount) return fail("unknown opcode " + std::to_string(op));
        if (detail::inside_block(kOpGroups[op])) return fail(std::string(kOpNames[op]) + ": outside a block");
        if (static_cast<Op>(op) == Op::Block) {
            if (auto done = detail::run_block(ops, in, h); !done) return done;
        } else if (!DecodeTable<H>::rows[op].run(h, in)) {
            return detail::refusal(op, h);
        }
    }
    if (in.remaining() != 0) return fail("operands left over");
    return {};
}

/// Runs the content of a run (RunDefine): drawing commands, within the block that calls it.
template <class H>
Result<void> decode_run(std::span<const std::byte> opcodes_last_first, std::span<const std::byte> operands, H& h) {
    return detail::run_drawing(detail::OpcodeWalk(opcodes_last_first), wire::OperandReader(operands), h, true);
}

}  // namespace wall::glapi
