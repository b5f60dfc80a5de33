// SPDX-License-Identifier: MIT
// A batch is executed in slices. Between two of them others draw, so a slice leaves the driver in the middle of
// nothing: glBegin, a list that is compiled, a query and the selection mode are ended and begun anew. Render thread.
//
// glBegin can be ended only between two points, lines, triangles or quads of their own; what is in the middle of a
// strip goes on to its end.
#include <algorithm>
#include <chrono>
#include <utility>

#include "common/wire/batch.h"
#include "tileserver/render/executor.h"
#include "tileserver/render/limits.h"
#include "tileserver/render/soft_switch.h"

namespace wall::tileserver {
namespace {

/// Vertices after which points, lines, triangles and quads are all whole.
constexpr std::uint64_t kWhole = 12;
/// Too short for hundreds of commands: their driver works for long on each.
constexpr std::chrono::microseconds kShortSlice{500};

}  // namespace

Result<void> Executor::start_batch(std::span<const std::byte> payload) {
    const auto batch = wire::split_batch(payload);
    if (!batch) return tl::unexpected(batch.error());
    if (holds_early(batch->opcodes)) return fail("a command that may hold the stream is not the last one of its batch");
    context_id_ = batch->context;
    context_ = &session_.context(context_id_);
    if (session_.context_count() > kMaxContexts) return fail("too many contexts");
    surfaces_known_ = false;
    batch_.emplace(batch->opcodes, batch->operands);
    batch_commands_ = batch->opcodes.size();
    batch_bytes_ = batch->opcodes.size() + batch->operands.size();
    counted_before_ = session_.work.state_bytes + session_.work.geometry_bytes;
    return {};
}

Result<bool> Executor::run_slice(Clock::time_point until) {
    until_ = until;
    closely_ = until - Clock::now() < kShortSlice;
    if (std::exchange(paused_, false)) resume();
    auto done = go_on();
    if (done && !*done) pause();
    else finish_batch();
    modes_.leave();
    session_.work.gl_errors += node_.driver.drain_errors();
    return done;
}

Result<void> Executor::run_batch(std::span<const std::byte> payload) {
    if (auto started = start_batch(payload); !started) return started;
    if (const auto done = run_slice(Clock::time_point::max()); !done) return tl::unexpected(done.error());
    return {};
}

Result<bool> Executor::go_on() {
    if (compiling_) go_on_compiling();
    if (call_.run) go_on_with_run();
    if (compiling_ || call_.run) return false;
    if (refused()) return fail(reason());
    return batch_->run(*this);
}

void Executor::finish_batch() {
    if (in_block_) end_block();  // the batch was refused within a block
    call_.run.reset();
    batch_.reset();
    Work& work = session_.work;
    work.commands += batch_commands_;
    const auto known = work.state_bytes + work.geometry_bytes - counted_before_;
    work.object_bytes += batch_bytes_ - std::min<std::uint64_t>(batch_bytes_, known);
}

void Executor::look_up_surfaces() {
    draw_surface_ = session_.surface(context_->draw);
    read_surface_ = session_.surface(context_->read);
    surfaces_known_ = true;
}

// ---- pauses ----

bool Executor::divisible() const {
    if (!in_begin_) return true;
    const bool independent =
        begin_.mode == GL_POINTS || begin_.mode == GL_LINES || begin_.mode == GL_TRIANGLES || begin_.mode == GL_QUADS;
    return independent && begin_.countable && modes_.mode() == GL_RENDER && (vertices_ - begin_.vertices) % kWhole == 0;
}

glapi::Pause Executor::should_pause() {
    const bool list_full = compiling_ && vertices_ - compiling_->list_start >= kRunPartVertices;
    if (!list_full && !call_.run && !out_of_time()) return closely_ ? glapi::Pause::closely : glapi::Pause::go_on;
    return divisible() ? glapi::Pause::now : glapi::Pause::soon;
}

void Executor::pause() {
    paused_ = true;
    if (!tile_open_ || !draws_) return;
    if (in_begin_) gl_.End();
    session_.queries.end();
    trail_.fold_into(node_.driver.mirror);
}

/// Others have drawn meanwhile, and the tiles may be others.
void Executor::resume() {
    surfaces_known_ = false;
    if (!tile_open_) return;
    look_up_surfaces();
    if (std::exchange(node_.current, context_) != context_) ++session_.work.context_switches;
    layer_ = draw_surface_ != nullptr ? draw_surface_->layer(tile_slot_) : nullptr;
    draws_ = layer_ != nullptr && layer_->complete();
    if (!draws_) return;
    const glstate::State before_block = context_->state;
    trail_.fold_into(context_->state);
    if (!switch_to(node_, session_, *context_, *layer_, counts_samples(tile_slot_))) refuse("too many queries");
    context_->state = before_block;
    modes_.enter();
    if (in_begin_) gl_.Begin(begin_.mode);
}

}  // namespace wall::tileserver
