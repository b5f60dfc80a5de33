// SPDX-License-Identifier: MIT
#include "tileserver/execute/run_commands.h"

#include <utility>

#include "common/wire/batch.h"
#include "tileserver/session/limits.h"

namespace wall::tileserver {

void RunCommands::ShareRun(RequestId request, ClientName run, std::span<const std::byte> key) {
    question_.ask(request, false, key, [this, run](auto have, const auto& asked) {
        if (have) keep(run, content_as<RunContent>(std::move(have)));
        else promised_ = {run, asked};
    });
}

void RunCommands::RunDefine(ClientName id, std::uint32_t commands, std::uint32_t operand_bytes,
                            std::span<const std::byte> content) {
    const std::size_t room = wire::padded4(commands);
    if (content.size() != room + operand_bytes) return execution_.refuse("content does not fit its sizes");
    if (!execution_.session.objects.affords(content.size())) return execution_.refuse(too_much("runs"));
    const auto opcodes = content.subspan(room - commands, commands);
    for (const std::byte op : opcodes)
        if (std::to_integer<std::size_t>(op) >= glapi::kOpCount ||
            glapi::kOpGroups[std::to_integer<std::size_t>(op)] != glapi::OpGroup::geometry)
            return execution_.refuse("a run holds geometry only");
    std::optional<glapi::ContentKey> promised;
    if (const auto promise = std::exchange(promised_, {}); promise && promise->first == id) {
        glapi::ContentHash hash;
        hash.RunDefine(commands, operand_bytes, content);
        if (hash.finish() != promise->second) return execution_.refuse("content is not what its name says");
        promised = promise->second;
    }
    compiling_.emplace(Compiling{id, promised, std::make_shared<RunContent>(execution_.gl, content.size()),
                                 glapi::DrawingRun(opcodes, content.subspan(room), true), block_.vertices});
    go_on();
}

void RunCommands::go_on() {
    while (compiling_) {
        compile_part();
        if (compiling_ && execution_.slice_is_over()) return;
    }
}

/// One list, to the run's end or to where another one should begin.
void RunCommands::compile_part() {
    execution_.gl.NewList(compiling_->run->add_list(), GL_COMPILE);
    compiling_->list_start = block_.vertices;
    block_.trail.clear();
    block_.draws = true;  // into the list
    block_.drawable = ~0u;
    if (block_.in_begin) geometry_.begin_drawing();
    const auto done = play_(compiling_->content);
    geometry_.end_drawing();
    block_.draws = false;
    block_.drawable = 0;
    execution_.gl.EndList();
    compiling_->run->parts.back().trail = block_.trail;
    block_.trail.clear();
    if (done && !*done) return;
    if (!done && !execution_.refused()) execution_.refuse("run: " + done.error().message);
    if (std::exchange(block_.in_begin, false)) execution_.refuse("a run ends between Begin and End");
    finish_run();
}

void RunCommands::finish_run() {
    const auto [id, promised, run, content, start] = std::move(*compiling_);
    compiling_.reset();
    if (execution_.refused()) return;
    keep(id, promised ? content_as<RunContent>(execution_.node.shared.store(*promised, run)) : run);
}

void RunCommands::keep(ClientName id, std::shared_ptr<const RunContent> content) {
    const auto run = execution_.session.objects.make<Run>(id);
    if (!run) return execution_.refuse(run.error().message);
    if (!content || !(*run)->adopt(std::move(content))) execution_.refuse(too_much("runs"));
}

bool RunCommands::list_is_full() const {
    return compiling_ && block_.vertices - compiling_->list_start >= kRunPartVertices;
}

}  // namespace wall::tileserver
