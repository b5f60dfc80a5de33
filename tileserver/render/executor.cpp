// SPDX-License-Identifier: MIT
#include "tileserver/render/executor.h"

#include <algorithm>
#include <utility>

#include "common/glstate/elements.h"
#include "common/wire/batch.h"
#include "tileserver/render/soft_switch.h"

namespace wall::tileserver {
namespace {

constexpr std::size_t kOpcodeAndWord = 1 + sizeof(std::uint32_t);  // of a state command, without the value

}  // namespace

Executor::Executor(RenderNode& node, SessionReplica& session, SessionOutput& output)
    : node_(node), session_(session), output_(output), gl_(node.driver.gl()), modes_(gl_) {}

Executor::~Executor() {
    node_.textures.leave(session_.asker());
    node_.runs.leave(session_.asker());
}

std::uint32_t Executor::state_bytes(std::uint32_t id) const { return glstate::element_bytes(id); }

bool Executor::State(std::uint32_t id, std::span<const std::byte> value) {
    session_.work.state_bytes += kOpcodeAndWord + value.size();
    if (!glstate::apply(context_->state, id, value)) return false;
    if (value.size() == glstate::ValueHistory::kValueBytes) context_->history.add(id, value.data());
    return true;
}

void Executor::StateSmall(std::uint32_t word) {
    session_.work.state_bytes += kOpcodeAndWord;
    const std::uint32_t value = word >> 16;
    if (!glstate::apply(context_->state, word & 0xffff, std::as_bytes(std::span(&value, 1))))
        refuse("no such small element");
}

void Executor::StateRecall(std::uint32_t word) {
    session_.work.state_bytes += kOpcodeAndWord;
    const std::uint32_t id = word & 0xffff;
    const auto value = context_->history.recall(id, word >> 16);
    if (value.empty() || !glstate::apply(context_->state, id, value)) refuse("recalls a value that it never had");
}

// ---- blocks ----

std::uint64_t Executor::begin_block(std::uint64_t tiles, std::size_t bytes) {
    session_.work.geometry_bytes += bytes;
    if (std::exchange(node_.current, context_) != context_) ++session_.work.context_switches;
    if (!surfaces_known_) look_up_surfaces();
    in_block_ = true;
    std::uint64_t present = 0;
    for (std::uint64_t rest = tiles; rest != 0 && draw_surface_ != nullptr; rest &= rest - 1) {
        const auto slot = static_cast<unsigned>(std::countr_zero(rest));
        if (draw_surface_->layer(slot) != nullptr) present |= std::uint64_t{1} << slot;
    }
    // With no layer at all the block is still decoded once, for what it leaves in the soft context.
    return present != 0 ? present : tiles & (~tiles + 1);
}

void Executor::begin_tile(unsigned slot) {
    if (tile_open_) finish_tile();
    tile_open_ = true;
    tile_slot_ = slot;
    trail_.clear();
    raster_ = glstate::el::raster_position::ref(context_->state);
    layer_ = draw_surface_ != nullptr ? draw_surface_->layer(slot) : nullptr;
    draws_ = layer_ != nullptr && layer_->complete();
    if (!draws_) return;
    if (!switch_to(node_, session_, *context_, *layer_, counts_samples(slot))) refuse("too many queries");
    modes_.enter();
}

bool Executor::counts_samples(unsigned slot) const {
    return slot != wire::kOffscreenSlot || !draw_surface_->on_tiles();
}

void Executor::finish_tile() {
    tile_open_ = false;
    if (in_begin_) {
        refuse("a block ends between Begin and End");
        in_begin_ = false;
        if (draws_) gl_.End();
    }
    session_.queries.end();
    if (draws_) trail_.fold_into(node_.driver.mirror);
}

void Executor::end_block() {
    if (tile_open_) finish_tile();
    if (!trail_.empty()) {
        trail_.fold_into(context_->state);
        if (draws_) node_.driver.unify_attributes(context_->state);
        trail_.clear();
    }
    if (!glstate::same(raster_, glstate::el::raster_position::ref(context_->state)))
        glstate::assign<glstate::el::raster_position>(context_->state, 0, raster_);
    in_block_ = draws_ = false;
    const GLenum buffer = glstate::el::draw_buffer::ref(context_->state);
    if (draw_surface_ != nullptr &&
        (!draw_surface_->format().layer.double_buffered || (buffer != GL_BACK && buffer != GL_BACK_LEFT)))
        ++node_.damage;
    layer_ = nullptr;
}

bool Executor::outside_begin() {
    if (in_begin_) refuse("between Begin and End");
    return !in_begin_;
}

}  // namespace wall::tileserver
