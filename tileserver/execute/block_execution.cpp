// SPDX-License-Identifier: MIT
#include "tileserver/execute/block_execution.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

#include "common/glstate/draw_buffers.h"
#include "common/wire/limits.h"
#include "tileserver/session/soft_switch.h"

namespace wall::tileserver {

std::uint64_t BlockExecution::begin(std::uint64_t tiles, std::size_t bytes) {
    execution_.session.work.geometry_bytes += bytes;
    note_switch();
    if (!execution_.targets_known) execution_.look_up_targets();
    block_.open = true;
    for_right_eye_ = false;
    SurfaceReplica* surface = execution_.draw_surface;
    std::uint64_t present = execution_.draw_framebuffer != nullptr ? tiles & (~tiles + 1) : 0;
    for_others_ = surface != nullptr && (tiles >> wire::kPartialSlot & 1) != 0;
    if (for_others_) tiles = std::max<std::uint64_t>(tiles & ~(std::uint64_t{1} << wire::kPartialSlot), 1);
    for (std::uint64_t rest = tiles; rest != 0 && surface != nullptr; rest &= rest - 1) {
        const auto slot = static_cast<unsigned>(std::countr_zero(rest));
        const bool there = for_others_ ? slot < partials().all().size() : surface->layer(slot) != nullptr;
        if (there) present |= std::uint64_t{1} << slot;
    }
    // With no layer at all the block is still decoded once, for what it leaves in the soft context.
    if (present == 0) present = tiles & (~tiles + 1);
    first_slot_ = static_cast<unsigned>(std::countr_zero(present));
    return present;
}

void BlockExecution::begin_tile(unsigned slot) {
    if (block_.tile_open) finish_tile();
    block_.tile_open = true;
    block_.slot = slot;
    execution_.pieces = {};
    mark_time();
    block_.trail.clear();
    block_.raster = glstate::el::raster_position::ref(execution_.context->state);
    find_target();
    if (block_.draws) enter_tile();
}

/// What is drawn to framebuffer objects is for no tile.
void BlockExecution::mark_time() {
    const bool for_tile = execution_.draw_framebuffer == nullptr && !for_others_ && block_.slot < wire::kTileSlots;
    execution_.node.tile_times.mark(for_tile ? std::optional(block_.slot) : std::nullopt);
}

bool BlockExecution::another_pass() {
    const SurfaceReplica* surface = execution_.draw_surface;
    for_right_eye_ = !for_right_eye_ && surface != nullptr && surface->format().stereo;
    return for_right_eye_;
}

void BlockExecution::note_switch() {
    const SoftContext* context = execution_.context;
    if (std::exchange(execution_.node.current, context) != context) ++execution_.session.work.context_switches;
}

void BlockExecution::find_target() {
    block_.layer = find_layer();
    block_.target = block_.layer;
    if (execution_.draw_framebuffer != nullptr) block_.target = execution_.updated(execution_.draw_framebuffer);
    block_.draws = block_.target != nullptr && block_.target->complete();
}

Layer* BlockExecution::find_layer() const {
    SurfaceReplica* surface = execution_.draw_surface;
    if (surface == nullptr) return nullptr;
    if (!for_others_) return surface->layer(block_.slot, for_right_eye_ ? geom::Eye::right : geom::Eye::left);
    return partials().draw_to(block_.slot);
}

PartialLayers& BlockExecution::partials() const { return execution_.session.partials(execution_.context->draw); }

bool BlockExecution::draws_right_only() const {
    return glstate::eye_of(glstate::el::draw_buffer::ref(execution_.context->state)) == geom::Eye::right;
}

/// What is drawn to both eyes counts once. Of a window partly off the wall, its tiles' samples count; of what several
/// nodes draw alike, those of one.
bool BlockExecution::counts_samples() const {
    const bool whole = block_.slot == wire::kOffscreenSlot && block_.layer != nullptr &&
                       !execution_.draw_surface->where().whole_window;
    if (block_.layer != nullptr && execution_.draw_surface->format().stereo && for_right_eye_ != draws_right_only())
        return false;
    if (block_.layer == nullptr || whole) return execution_.context->counts_samples;
    return block_.slot != wire::kOffscreenSlot || !execution_.draw_surface->on_tiles();
}

void BlockExecution::enter_tile() {
    block_.drawable = block_.undrawable = 0;
    if (!switch_to(execution_.node, execution_.session, *execution_.context, *block_.target,
                   {counts_samples(), block_.slot == first_slot_ && !for_right_eye_}))
        execution_.refuse("no such query, or " + too_much("objects"));
    execution_.modes.enter();
}

void BlockExecution::finish_tile() {
    block_.tile_open = false;
    if (block_.in_begin) {
        execution_.refuse("a block ends between Begin and End");
        block_.in_begin = false;
        geometry_.end_drawing();
    }
    execution_.node.driver.end_queries();
    execution_.node.driver.stop_capturing();
    execution_.node.driver.settle_memory();
    if (block_.draws) block_.trail.fold_into(execution_.node.driver.mirror);
}

void BlockExecution::end() {
    if (block_.tile_open) finish_tile();
    execution_.node.tile_times.mark(std::nullopt);
    glstate::State& state = execution_.context->state;
    if (!block_.trail.empty()) {
        block_.trail.fold_into(state);
        if (block_.draws) execution_.node.driver.unify_attributes(state);
        block_.trail.clear();
    }
    if (!glstate::same(block_.raster, glstate::el::raster_position::ref(state)))
        glstate::assign<glstate::el::raster_position>(state, 0, block_.raster);
    block_.open = block_.draws = false;
    block_.target = nullptr;
    block_.layer = nullptr;
    if (shows_at_once()) ++execution_.node.damage;
}

/// What is drawn to the front buffer needs no swap.
bool BlockExecution::shows_at_once() const {
    const SurfaceReplica* surface = execution_.draw_surface;
    const GLenum buffer = glstate::el::draw_buffer::ref(execution_.context->state);
    return surface != nullptr && (!surface->format().layer.double_buffered || !glstate::names_back_only(buffer));
}

void BlockExecution::pause() {
    if (!block_.tile_open || !block_.draws) return;
    geometry_.end_drawing();
    execution_.node.driver.end_queries();
    execution_.node.driver.stop_capturing();
    execution_.node.driver.settle_memory();
    block_.trail.fold_into(execution_.node.driver.mirror);
    execution_.node.tile_times.mark(std::nullopt);
}

void BlockExecution::resume() {
    execution_.targets_known = false;
    if (!block_.tile_open) return;
    mark_time();
    execution_.look_up_targets();
    note_switch();
    find_target();
    if (!block_.draws) return;
    const glstate::State before_block = execution_.context->state;
    block_.trail.fold_into(execution_.context->state);
    enter_tile();
    execution_.context->state = before_block;
    if (block_.in_begin) geometry_.begin_drawing();
}

}  // namespace wall::tileserver
