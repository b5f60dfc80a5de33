// SPDX-License-Identifier: MIT
#include "tileserver/execute/executor.h"

#include <algorithm>
#include <utility>

#include "common/wire/batch.h"
#include "tileserver/session/limits.h"

namespace wall::tileserver {
namespace {

/// Vertices after which points, lines, triangles and quads are all whole.
constexpr std::uint64_t kWhole = 12;
/// Too short for hundreds of commands: their driver works for long on each.
constexpr std::chrono::microseconds kShortSlice{500};
constexpr std::uint64_t kFewCommands = 2000;

}  // namespace

Executor::Executor(RenderNode& node, SessionReplica& session, SessionOutput& output)
    : execution_(node, session, output, *this), question_(execution_) {}

Result<void> Executor::start_batch(std::span<const std::byte> payload) {
    const auto batch = wire::split_batch(payload);
    if (!batch) return tl::unexpected(batch.error());
    SessionReplica& session = execution_.session;
    if (holds_early(session, batch->opcodes))
        return fail("a command that may hold the stream is not the last one of its batch");
    execution_.context_id = batch->context;
    execution_.context = &session.context(batch->context);
    if (session.context_count() > kMaxContexts) return fail("too many contexts");
    execution_.targets_known = false;
    batch_.emplace(batch->opcodes, batch->operands);
    batch_commands_ = batch->opcodes.size();
    batch_bytes_ = batch->opcodes.size() + batch->operands.size();
    counted_before_ = session.work.state_bytes + session.work.geometry_bytes;
    return {};
}

Result<bool> Executor::run_slice(const Slice& slice) {
    execution_.slice = slice;
    execution_.told = 0;
    closely_ = slice.commands < kFewCommands || slice.until - Clock::now() < kShortSlice;
    if (std::exchange(paused_, false)) blocks_.resume();
    auto done = go_on();
    paused_ = done && !*done;
    if (paused_) blocks_.pause();
    else finish_batch();
    execution_.modes.leave();
    execution_.session.work.gl_errors += execution_.node.driver.drain_errors();
    return done;
}

Result<void> Executor::run_batch(std::span<const std::byte> payload) {
    if (auto started = start_batch(payload); !started) return started;
    if (const auto done = run_slice({}); !done) return tl::unexpected(done.error());
    return {};
}

Result<bool> Executor::go_on() {
    if (program.trying()) program.go_on();
    if (program.trying()) return false;
    if (partial.merging()) partial.go_on();
    if (partial.merging()) return false;
    if (run.compiling()) run.go_on();
    if (draw.calling()) draw.go_on();
    if (run.compiling() || draw.calling()) return false;
    if (refused()) return fail(reason());
    return batch_->run(*this);
}

void Executor::finish_batch() {
    execution_.told += batch_->untold();
    if (geometry.block().open) blocks_.end();  // the batch was refused within a block
    draw.stop();
    batch_.reset();
    Work& work = execution_.session.work;
    work.commands += batch_commands_;
    const auto known = work.state_bytes + work.geometry_bytes - counted_before_;
    work.object_bytes += batch_bytes_ - std::min<std::uint64_t>(batch_bytes_, known);
}

Result<bool> Executor::pursue_question() {
    const bool answered = question_.pursue();
    if (refused()) return fail(reason());
    return answered;
}

// ---- pauses ----

bool Executor::divisible() {
    const OpenBlock& block = geometry.block();
    if (!block.in_begin) return true;
    const auto& begin = block.begin;
    const bool independent =
        begin.mode == GL_POINTS || begin.mode == GL_LINES || begin.mode == GL_TRIANGLES || begin.mode == GL_QUADS;
    return independent && begin.countable && execution_.modes.mode() == GL_RENDER &&
           (block.vertices - begin.vertices) % kWhole == 0;
}

glapi::Pause Executor::should_pause(std::size_t told) {
    execution_.told += told;
    if (program.trying() || partial.merging()) return glapi::Pause::now;
    // Where a list ends another begins, and by where that is Mesa cuts strips and quads into other triangles: so it is
    // no matter of time.
    const bool over = run.compiling() ? run.list_is_full() : draw.calling() || execution_.slice_is_over();
    if (!over) return closely_ ? glapi::Pause::closely : glapi::Pause::go_on;
    return divisible() ? glapi::Pause::now : glapi::Pause::soon;
}

}  // namespace wall::tileserver
