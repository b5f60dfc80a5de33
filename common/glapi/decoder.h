// SPDX-License-Identifier: MIT
// Decodes packed batches: walks the opcodes, checks the operands' bounds, calls a handler H. A bad batch is refused at
// its first bad command, with the reason; what came before it has been executed. One thread; H's.
//
// H derives from glapi::Handler and offers
//   - one member per command of proto/gl/wire.toml: `void Clear(uint32_t mask)`, ... (bytes operand: std::span<const
//     std::byte>); if H::kByGroup is true, as members of an object for each group, which H has under the group's name:
//     `h.draw.Clear(mask)`;
//   - with those of group `stream`: `uint32_t state_bytes(uint32_t id)`, 0 = no such element (glstate::element_bytes),
//     and `bool State(uint32_t id, std::span<const std::byte> value)`, false = bad value;
//   - `uint64_t begin_block(uint64_t tiles, size_t bytes)`: the tiles to run the block for (all asked for, or fewer);
//     `bytes` of commands it takes in the batch; `void begin_tile(unsigned slot)`, `bool another_pass()` (whether to
//     begin that tile once more), `void end_block()`.
// A member that cannot go on calls `refuse("why")`. A handler that hides Handler::should_pause() can stop between two
// commands, also in the middle of a block; BatchRun and DrawingRun then go on where they stood.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "common/base/result.h"
#include "common/wire/operand_reader.h"
#include "gen/glapi/decode.gen.h"

namespace wall::glapi {

/// What a handler answers when it is asked, now and then, whether others should have their turn.
enum class Pause : std::uint8_t {
    go_on,
    closely,  ///< no, but ask again after a few commands: the others wait for little
    soon,     ///< yes, but what it is in the middle of cannot be cut here: ask again after the next command
    now,
};

/// Of a handler: sticky, the first reason stays.
class Refusal {
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

class Handler : public Refusal {
public:
    static constexpr bool kByGroup = false;
    /// `told`: commands since it was asked last.
    static constexpr Pause should_pause([[maybe_unused]] std::size_t told) { return Pause::go_on; }
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

inline bool inside_block(OpGroup group) {
    return group == OpGroup::geometry || group == OpGroup::draw || group == OpGroup::array_draw ||
           group == OpGroup::blit || group == OpGroup::instanced_draw || group == OpGroup::captured_draw ||
           group == OpGroup::dispatch || group == OpGroup::texture_barrier || group == OpGroup::image_copy ||
           group == OpGroup::piece_range;
}

template <class H>
tl::unexpected<Error> refusal(std::size_t op, const H& h) {
    const std::string name = op < kOpCount ? kOpNames[op] : "opcode " + std::to_string(op);
    return fail(name + ": " + (h.refused() ? h.reason() : std::string("bad operands")));
}

/// Says when a handler is asked whether it should pause: geometry is too quick to look at a clock behind each of it.
class PauseWatch {
public:
    /// After a command of that group. True: stop here.
    template <class H>
    bool after(OpGroup group, H& h) {
        const bool quick = group == OpGroup::geometry || group == OpGroup::stream;
        return after(quick ? 1 : kLook, 1, h);
    }
    /// `untold`: commands of its tiles.
    template <class H>
    bool after_block(std::size_t untold, H& h) {
        return after(kBlock, untold, h);
    }
    /// Commands of which the handler has not heard.
    std::size_t untold() const { return untold_; }

private:
    static constexpr int kLook = 512, kClose = 16, kBlock = 64;  // in quick commands
    template <class H>
    bool after(int weight, std::size_t told, H& h) {
        left_ -= weight;
        untold_ += told;
        if (left_ > 0) [[likely]]
            return false;
        const Pause wanted = h.should_pause(std::exchange(untold_, 0));
        left_ = wanted == Pause::soon ? 1 : wanted == Pause::closely ? kClose : kLook;
        return wanted == Pause::now;
    }
    int left_ = kLook;
    std::size_t untold_ = 0;
};

}  // namespace detail

/// Commands of groups geometry and draw only, which consume their operands exactly: those of a block, or the content of
/// a run (RunDefine; `nested`, so that it may call no run). The bytes must stay as long as it lives.
class DrawingRun {
public:
    DrawingRun(std::span<const std::byte> opcodes_last_first, std::span<const std::byte> operands, bool nested)
        : ops_(opcodes_last_first), operands_(operands), nested_(nested) {}

    /// True: at its end. False: the handler wanted a pause; call it again.
    template <class H>
    Result<bool> run(H& h) {
        while (ops_.remaining() != 0) {
            const std::size_t op = ops_.take();
            if (op >= kOpCount || !detail::inside_block(kOpGroups[op]))
                return fail("a block may not hold " + std::string(op < kOpCount ? kOpNames[op] : "an unknown opcode"));
            if (nested_ && static_cast<Op>(op) == Op::RunCall) return fail("a run may not call a run");
            if (!DecodeTable<H>::rows[op].run(h, operands_)) return detail::refusal(op, h);
            if (watch_.after(kOpGroups[op], h)) return false;
        }
        if (operands_.remaining() != 0) return fail("operands left over");
        return true;
    }
    /// Commands of which the handler has not heard: the last ones.
    std::size_t untold() const { return watch_.untold(); }

private:
    detail::OpcodeWalk ops_;
    wire::OperandReader operands_;
    bool nested_;
    detail::PauseWatch watch_;
};

/// A batch that is being executed (wire::split_batch gives the two spans, which must stay as long as it lives).
class BatchRun {
public:
    BatchRun(std::span<const std::byte> opcodes_last_first, std::span<const std::byte> operands)
        : ops_(opcodes_last_first), operands_(operands) {}

    /// True: at its end. False: the handler wanted a pause; call it again.
    template <class H>
    Result<bool> run(H& h) {
        for (;;) {
            if (in_block_) {
                if (auto done = go_on_with_block(h); !done || !*done) return done;
                if (watch_.after_block(std::exchange(untold_, 0), h)) return false;
            }
            if (ops_.remaining() == 0) break;
            const std::size_t op = ops_.take();
            if (op >= kOpCount) return fail("unknown opcode " + std::to_string(op));
            if (detail::inside_block(kOpGroups[op])) return fail(std::string(kOpNames[op]) + ": outside a block");
            if (static_cast<Op>(op) == Op::Block) {
                if (auto begun = begin_block(h); !begun) return tl::unexpected(begun.error());
                continue;
            }
            if (!DecodeTable<H>::rows[op].run(h, operands_)) return detail::refusal(op, h);
            if (watch_.after(kOpGroups[op], h)) return false;
        }
        if (operands_.remaining() != 0) return fail("operands left over");
        return true;
    }
    /// At its end: commands of which the handler has not heard.
    std::size_t untold() const { return watch_.untold(); }

private:
    template <class H>
    Result<void> begin_block(H& h) {
        const std::uint64_t low = operands_.get<std::uint32_t>(), high = operands_.get<std::uint32_t>();
        const std::size_t commands = operands_.get<std::uint32_t>(), bytes = operands_.get<std::uint32_t>();
        content_ = operands_.raw(bytes);
        if (!operands_.ok() || ops_.remaining() < commands) return fail("Block: reaches over the batch's end");
        body_ = std::span(ops_.next - commands, commands);
        ops_.next -= commands;
        tiles_ = h.begin_block(low | high << 32, detail::kBlockBytes + commands + bytes) & (low | high << 32);
        in_block_ = true;
        return {};
    }
    template <class H>
    Result<bool> go_on_with_block(H& h) {
        while (tiles_ != 0 && !h.refused()) {
            if (!tile_) {
                h.begin_tile(static_cast<unsigned>(std::countr_zero(tiles_)));
                tile_.emplace(body_, content_, false);
            }
            if (auto done = tile_->run(h); !done || !*done) return done;
            untold_ += tile_->untold();
            tile_.reset();
            if (!h.another_pass()) tiles_ &= tiles_ - 1;
        }
        in_block_ = false;
        h.end_block();
        if (h.refused()) return detail::refusal(static_cast<std::size_t>(Op::Block), h);
        return true;
    }

    detail::OpcodeWalk ops_;
    wire::OperandReader operands_;
    detail::PauseWatch watch_;
    // Of the block that is being executed.
    bool in_block_ = false;
    std::span<const std::byte> body_, content_;
    std::uint64_t tiles_ = 0;         ///< that are left, with the one that is drawn in
    std::optional<DrawingRun> tile_;  ///< what is left to be drawn in it
    std::size_t untold_ = 0;          ///< commands in tiles before, of which the handler has not heard
};

/// Runs a batch to its end.
template <class H>
Result<void> decode(std::span<const std::byte> opcodes_last_first, std::span<const std::byte> operands, H& h) {
    BatchRun batch(opcodes_last_first, operands);
    for (;;) {
        const auto done = batch.run(h);
        if (!done) return tl::unexpected(done.error());
        if (*done) return {};
    }
}

/// Runs the content of a run (RunDefine) to its end.
template <class H>
Result<void> decode_run(std::span<const std::byte> opcodes_last_first, std::span<const std::byte> operands, H& h) {
    DrawingRun content(opcodes_last_first, operands, true);
    for (;;) {
        const auto done = content.run(h);
        if (!done) return tl::unexpected(done.error());
        if (*done) return {};
    }
}

}  // namespace wall::glapi
