// SPDX-License-Identifier: MIT
// Runs: geometry that is defined once and called by name. A large one is several lists of the driver, so that a call of
// it can be left between two of them. Render thread.
#include <utility>

#include "common/wire/batch.h"
#include "tileserver/render/executor.h"
#include "tileserver/render/limits.h"

namespace wall::tileserver {

void Executor::RunDefine(ClientName id, std::uint32_t commands, std::uint32_t operand_bytes,
                         std::span<const std::byte> content) {
    const std::size_t room = wire::padded4(commands);
    if (content.size() != room + operand_bytes) return refuse("content does not fit its sizes");
    if (session_.run_bytes + content.size() > kMaxRunBytes) return refuse("more runs than a session may have");
    const auto opcodes = content.subspan(room - commands, commands);
    for (const std::byte op : opcodes)
        if (std::to_integer<std::size_t>(op) >= glapi::kOpCount ||
            glapi::kOpGroups[std::to_integer<std::size_t>(op)] != glapi::OpGroup::geometry)
            return refuse("a run holds geometry only");
    std::optional<glapi::ContentKey> promised;
    if (const auto promise = std::exchange(promised_run_, {}); promise && promise->first == id) {
        glapi::ContentHash hash;
        hash.RunDefine(commands, operand_bytes, content);
        if (hash.finish() != promise->second) return refuse("content is not what its name says");
        promised = promise->second;
    }
    compiling_.emplace(Compiling{id, promised, std::make_shared<Run>(gl_),
                                 glapi::DrawingRun(opcodes, content.subspan(room), true), vertices_});
    compiling_->run->bytes = content.size();
    go_on_compiling();
}

void Executor::go_on_compiling() {
    while (compiling_) {
        compile_part();
        if (compiling_ && out_of_time()) return;
    }
}

/// One list, to the run's end or to where another one should begin.
void Executor::compile_part() {
    gl_.NewList(compiling_->run->add_list(), GL_COMPILE);
    compiling_->list_start = vertices_;
    trail_.clear();
    draws_ = true;  // into the list
    if (in_begin_) gl_.Begin(begin_.mode);
    const auto done = compiling_->content.run(*this);
    if (in_begin_) gl_.End();
    draws_ = false;
    gl_.EndList();
    compiling_->run->parts.back().trail = trail_;
    trail_.clear();
    if (done && !*done) return;
    if (!done && !refused()) refuse("run: " + done.error().message);
    if (std::exchange(in_begin_, false)) refuse("a run ends between Begin and End");
    finish_run();
}

void Executor::finish_run() {
    const auto [id, promised, run, content, start] = std::move(*compiling_);
    compiling_.reset();
    if (refused()) return;
    keep_run(id, promised ? node_.runs.store(*promised, run) : run);
}

bool Executor::keep_run(ClientName id, std::shared_ptr<const Run> run) {
    RunDelete(id);
    session_.run_bytes += run->bytes;
    session_.runs[id] = std::move(run);
    if (session_.run_bytes > kMaxRunBytes || session_.runs.size() > kMaxRuns)
        refuse("more runs than a session may have");
    return !refused();
}

void Executor::RunDelete(ClientName id) {
    const auto at = session_.runs.find(id);
    if (at == session_.runs.end()) return;
    session_.run_bytes -= at->second->bytes;
    session_.runs.erase(at);
}

void Executor::RunCall(ClientName id) {
    if (!outside_begin()) return;
    const auto at = session_.runs.find(id);
    if (at == session_.runs.end()) return refuse("run " + std::to_string(id.value) + " is not defined");
    call_ = {at->second, 0};
    go_on_with_run();
}

void Executor::go_on_with_run() {
    const auto& parts = call_.run->parts;
    while (call_.next < parts.size()) {
        const Run::Part& part = parts[call_.next++];
        if (draws_) gl_.CallList(part.list);
        trail_.append(part.trail);
        if (call_.next < parts.size() && out_of_time()) return;
    }
    call_.run.reset();
}

}  // namespace wall::tileserver
