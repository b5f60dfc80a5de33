// SPDX-License-Identifier: MIT
#include "tools/wallplay/rewrite.h"

#include <cstring>

namespace wall::wallplay {

using glapi::Op;

namespace {

/// A block is executed on some tile even where none shows the window: what it leaves in the context counts.
constexpr std::uint64_t kSomeSlot = 1;

/// `opcodes`: last first.
void append(wire::PackBuffer& to, std::span<const std::byte> opcodes, std::span<const std::byte> operands) {
    if (opcodes.empty()) return;
    for (std::size_t i = opcodes.size() - 1; i > 0; --i) to.append(std::to_integer<std::uint8_t>(opcodes[i]), 0);
    std::byte* at = to.append(std::to_integer<std::uint8_t>(opcodes[0]), operands.size());
    if (!operands.empty()) std::memcpy(at, operands.data(), operands.size());
}

}  // namespace

void DrawnSurfaces::note(ContextId context, const glstate::Command& command) {
    if (command.op == Op::Bind) draws_[context] = SurfaceId(command.word(0));
    else if (command.op == Op::ContextDestroy) draws_.erase(ContextId(command.word(0)));
    else if (command.op == Op::BeginAgain) draws_.clear();
}

SurfaceId DrawnSurfaces::of(ContextId context) const {
    const auto found = draws_.find(context);
    return found == draws_.end() ? SurfaceId() : found->second;
}

bool is_of_windows(Op op) {
    return op == Op::SurfaceCreate || op == Op::SurfacePlace || op == Op::SurfaceDestroy || op == Op::SurfaceViews ||
           op == Op::Swap || op == Op::SwapOffscreen;
}

void rewrite(const glstate::Command& command, SurfaceId drawn, const NodeView& view, wire::PackBuffer& to) {
    const auto op = static_cast<std::uint8_t>(command.op);
    if (command.op == Op::Block) {
        const std::uint64_t shown = view.slots(drawn), slots = shown != 0 ? shown : kSomeSlot;
        glapi::pack::Block(to, static_cast<std::uint32_t>(slots), static_cast<std::uint32_t>(slots >> 32),
                           static_cast<std::uint32_t>(command.block_opcodes.size()),
                           static_cast<std::uint32_t>(command.block_operands.size()));
        return append(to, command.block_opcodes, command.block_operands);
    }
    if (command.op == Op::Bind)
        return glapi::pack::Bind(to, view.surface(SurfaceId(command.word(0))),
                                 view.surface(SurfaceId(command.word(1))));
    // Of those that ask, linking does something besides; what was promised to others was asked for before.
    if ((glapi::kOpAsks[op] && command.op != Op::ProgramLink) || command.op == Op::TexShared) return;
    std::byte* at = to.append(op, command.operands.size());
    if (!command.operands.empty()) std::memcpy(at, command.operands.data(), command.operands.size());
    if (command.op == Op::ProgramLink) std::memset(at, 0, sizeof(RequestId::value));
}

}  // namespace wall::wallplay
