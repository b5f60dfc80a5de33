// SPDX-License-Identifier: MIT
#include "client_lib/geometry/dealable.h"

#include "common/glstate/draw_buffers.h"

namespace wall::client {
namespace {

namespace el = glstate::el;
constexpr auto kCategory = static_cast<std::size_t>(glstate::Category::depth_stencil);

bool nearer_wins(std::uint32_t func) {
    return func == GL_LESS || func == GL_LEQUAL || func == GL_GREATER || func == GL_GEQUAL;
}

/// Something of what was there before may be left in a pixel that is drawn.
bool mixes(const glstate::State& state) {
    return (el::blend_enabled::ref(state) & 1) != 0 || el::color_logic_op::ref(state) != 0 ||
           !glstate::writes_all_channels(state);
}

bool counts_or_captures(const glstate::State& state) {
    return el::occlusion_query::ref(state) != 0 || el::capture::ref(state) != 0 || glstate::counts_primitives(state);
}

}  // namespace

std::optional<std::uint32_t> composed_by(const glstate::State& state) {
    const std::uint32_t func = el::depth_func::ref(state);
    const bool by_depth = el::depth_test::ref(state) != 0 && el::depth_mask::ref(state) != 0 && nearer_wins(func);
    if (!by_depth || el::stencil_test::ref(state) != 0) return std::nullopt;
    if (mixes(state) || counts_or_captures(state)) return std::nullopt;
    if (el::draw_buffer::ref(state) != GL_BACK) return std::nullopt;
    if (state.local.render_mode != GL_RENDER) return std::nullopt;
    return func;
}

MarkingState::MarkingState(glstate::State& state, Ids& ids)
    : state_(state), own_(state.depth_stencil), named_(state.ids[kCategory]) {
    if (ids.own != named_) ids = {named_, glstate::next_value_id()};
    el::stencil_test::ref(state) = 1;
    for (unsigned face = 0; face < 2; ++face) {
        el::stencil_func::ref(state, face) = {GL_ALWAYS, 1, 0xff};
        el::stencil_op::ref(state, face) = {GL_KEEP, GL_KEEP, GL_REPLACE};
        el::stencil_mask::ref(state, face) = 0xff;
    }
    state.ids.take(kCategory, ids.marking);
}

MarkingState::~MarkingState() {
    state_.depth_stencil = own_;
    state_.ids.take(kCategory, named_);
}

}  // namespace wall::client
