// SPDX-License-Identifier: MIT
#include "bench/simulate/traffic_count.h"

#include "common/wire/batch.h"

namespace wall::simulate {
namespace {

using glapi::Op;

/// Whether the first operand names an answer that is waited for.
bool asks(Op op) {
    switch (op) {
        case Op::Sync:
        case Op::ReadPixels:
        case Op::SamplePosition:
        case Op::RasterPosition:
        case Op::RenderMode:
        case Op::ShareTexture:
        case Op::Compress:
        case Op::ShareRun:
        case Op::ShaderCompile:
        case Op::ProgramLink:
        case Op::QueryResult:
        case Op::BufferRead:
        case Op::RenderbufferRead:
        case Op::TexRead:
        case Op::CaptureCounts:
        case Op::FormatQuery: return true;
        default: return false;
    }
}

/// How many vertices a draw names; 0: it is none, or the node alone knows.
std::uint64_t drawn(const glstate::Command& now) {
    const auto indices = [&](std::size_t count_word, std::size_t type_word) -> std::uint64_t {
        constexpr std::uint32_t kByte = 0x1401, kShort = 0x1403;
        const std::uint32_t type = now.word(type_word), bytes = now.word(count_word);
        return type == kByte ? bytes : type == kShort ? bytes / 2 : bytes / 4;
    };
    switch (now.op) {
        case Op::Vertex2f:
        case Op::Vertex3f:
        case Op::Vertex4f: return 1;
        case Op::DrawArrays: return now.word(4);
        case Op::DrawElements: return now.word(3);
        case Op::DrawIndices: return indices(4, 2);
        case Op::DrawArraysInstanced: return std::uint64_t{now.word(3)} * now.word(4);
        case Op::DrawElementsInstanced: return std::uint64_t{now.word(2)} * now.word(6);
        case Op::DrawIndicesInstanced: return indices(7, 2) * now.word(4);
        default: return 0;
    }
}

}  // namespace

void Traffic::operator+=(const Traffic& other) {
    plain_bytes += other.plain_bytes;
    commands += other.commands;
    blocks += other.blocks;
    vertices += other.vertices;
    in_pieces += other.in_pieces;
}

Result<TrafficCount::Seen> TrafficCount::look(std::span<const std::byte> payload) {
    const auto batch = wire::split_batch(payload);
    if (!batch) return tl::unexpected(batch.error());
    Seen seen;
    seen.traffic.plain_bytes = payload.size();
    if (auto counted = count(glstate::CommandWalk(batch->opcodes, batch->operands), seen); !counted)
        return tl::unexpected(counted.error());
    return seen;
}

Result<void> TrafficCount::count(glstate::CommandWalk walk, Seen& seen) {
    for (;;) {
        const auto command = walk.next();
        if (!command) return tl::unexpected(command.error());
        if (!*command) return {};
        const glstate::Command& now = **command;
        ++seen.traffic.commands;
        count(now, seen);
        if (now.op == Op::Block) {
            ++seen.traffic.blocks;
            const glstate::CommandWalk inside(now.block_opcodes, now.block_operands);
            if (auto counted = count(inside, seen); !counted) return counted;
        } else if (now.op == Op::RunDefine) {
            // Its content is opcodes, last first, padded in front to 4; then operands.
            const std::size_t opcodes = now.word(1), operands = now.word(2), fixed = 4 * sizeof(std::uint32_t);
            const std::size_t padding = wire::padded4(opcodes) - opcodes;
            if (now.operands.size() < fixed + padding + opcodes + operands) return fail("RunDefine: bad operands");
            Seen run;
            const glstate::CommandWalk inside(now.operands.subspan(fixed + padding, opcodes),
                                              now.operands.subspan(fixed + padding + opcodes, operands));
            if (auto counted = count(inside, run); !counted) return counted;
            run_vertices_[now.word(0)] = run.traffic.vertices;
        }
    }
}

void TrafficCount::count(const glstate::Command& now, Seen& seen) {
    const std::uint64_t vertices = drawn(now);
    seen.traffic.vertices += vertices;
    if ((now.op == Op::DrawArrays || now.op == Op::DrawElements) && now.word(1) != 0)
        seen.traffic.in_pieces += vertices;
    if (now.op == Op::Swap) seen.swaps.push_back({SurfaceId(now.word(0)), now.word(1)});
    if (now.op == Op::RunCall) {
        const auto known = run_vertices_.find(now.word(0));
        if (known != run_vertices_.end()) seen.traffic.vertices += known->second;
    }
    if (asks(now.op) && now.word(0) != 0)
        seen.questions.push_back({RequestId(now.word(0)), glapi::kOpNames[static_cast<std::size_t>(now.op)]});
}

}  // namespace wall::simulate
