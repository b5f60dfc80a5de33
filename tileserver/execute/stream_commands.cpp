// SPDX-License-Identifier: MIT
#include "tileserver/execute/stream_commands.h"

namespace wall::tileserver {
namespace {

constexpr std::size_t kOpcodeAndWord = 1 + sizeof(std::uint32_t);  // of a state command, without the value

}  // namespace

bool StreamCommands::State(std::uint32_t id, std::span<const std::byte> value) {
    execution_.session.work.state_bytes += kOpcodeAndWord + value.size();
    if (!glstate::apply(execution_.context->state, id, value)) return false;
    if (value.size() == glstate::ValueHistory::kValueBytes) execution_.context->history.add(id, value.data());
    return true;
}

void StreamCommands::StateSmall(std::uint32_t word) {
    execution_.session.work.state_bytes += kOpcodeAndWord;
    const std::uint32_t value = word >> 16;
    if (!glstate::apply(execution_.context->state, word & 0xffff, std::as_bytes(std::span(&value, 1))))
        execution_.refuse("no such small element");
}

void StreamCommands::StateRecall(std::uint32_t word) {
    execution_.session.work.state_bytes += kOpcodeAndWord;
    const std::uint32_t id = word & 0xffff;
    const auto value = execution_.context->history.recall(id, word >> 16);
    if (value.empty() || !glstate::apply(execution_.context->state, id, value))
        execution_.refuse("recalls a value that it never had");
}

void StreamCommands::Sync(RequestId request) {
    {
        const Timed timed(execution_.session.work.render);
        execution_.gl.Finish();
    }
    execution_.output.reply(request, {});
}

void StreamCommands::BeginAgain() {
    execution_.session.begin_again();
    execution_.node.driver.forget_target();  // it may have been an object
    execution_.context = &execution_.session.context(execution_.context_id);
    execution_.targets_known = false;
}

}  // namespace wall::tileserver
