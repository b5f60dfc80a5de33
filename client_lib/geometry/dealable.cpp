// SPDX-License-Identifier: MIT
#include "client_lib/geometry/dealable.h"

#include <array>

#include "common/glstate/draw_buffers.h"

namespace wall::client {
namespace {

namespace el = glstate::el;

bool nearer_wins(std::uint32_t func) {
    return func == GL_LESS || func == GL_LEQUAL || func == GL_GREATER || func == GL_GEQUAL;
}

bool blends(const glstate::State& state) { return (el::blend_enabled::ref(state) & 1) != 0; }

/// Something of what was there before may be left in a pixel that is drawn, but for blending.
bool mixes(const glstate::State& state) {
    return el::color_logic_op::ref(state) != 0 || !glstate::writes_all_channels(state);
}

bool counts_or_captures(const glstate::State& state) {
    return el::occlusion_query::ref(state) != 0 || el::capture::ref(state) != 0 || glstate::counts_primitives(state);
}

/// What a pixel's colour is multiplied by depends on what was there before, or on a second colour of a shader.
bool knows_what_is_there(std::uint32_t source_factor) {
    return source_factor == GL_DST_COLOR || source_factor == GL_ONE_MINUS_DST_COLOR || source_factor == GL_DST_ALPHA ||
           source_factor == GL_ONE_MINUS_DST_ALPHA || source_factor == GL_SRC_ALPHA_SATURATE ||
           source_factor == GL_SRC1_COLOR || source_factor == GL_ONE_MINUS_SRC1_COLOR ||
           source_factor == GL_SRC1_ALPHA || source_factor == GL_ONE_MINUS_SRC1_ALPHA;
}

/// The factors by which a pixel's alpha becomes 1 - the share that is left of what was there before.
std::array<std::uint32_t, 2> alpha_of_shares(const glstate::BlendFunc& func) {
    if (func.dst_rgb == GL_ONE) return {GL_ZERO, GL_ONE};
    return {GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
}

/// Each draw adds to a share of what was there: shares multiply, so parts can be put together from any two neighbours
/// on (Porter and Duff 1984).
bool blends_over(const glstate::State& state, bool has_alpha) {
    const glstate::BlendFunc& func = el::blend_func::ref(state);
    const glstate::BlendEquation& equation = el::blend_equation::ref(state);
    const bool shares = func.dst_rgb == GL_ONE || func.dst_rgb == GL_ONE_MINUS_SRC_ALPHA;
    if (!shares || knows_what_is_there(func.src_rgb)) return false;
    if (equation.rgb != GL_FUNC_ADD || el::framebuffer_srgb::ref(state) != 0) return false;
    const bool as_shares =
        equation.alpha == GL_FUNC_ADD && std::array{func.src_alpha, func.dst_alpha} == alpha_of_shares(func);
    return !has_alpha || as_shares;
}

}  // namespace

std::optional<std::uint32_t> composed_by(const glstate::State& state, bool has_alpha) {
    if (el::stencil_test::ref(state) != 0 || mixes(state) || counts_or_captures(state)) return std::nullopt;
    if (el::draw_buffer::ref(state) != GL_BACK || state.local.render_mode != GL_RENDER) return std::nullopt;
    const std::uint32_t func = el::depth_func::ref(state);
    const bool tests = el::depth_test::ref(state) != 0;
    if (blends(state)) {
        if (tests || !blends_over(state, has_alpha)) return std::nullopt;
        return GL_BLEND;
    }
    if (!tests || el::depth_mask::ref(state) == 0 || !nearer_wins(func)) return std::nullopt;
    return func;
}

MarkingState::MarkingState(glstate::State& state, std::uint32_t by, Ids& ids)
    : state_(state),
      own_(state.depth_stencil),
      own_func_(el::blend_func::ref(state)),
      own_equation_(el::blend_equation::ref(state)),
      by_(by),
      ids_(ids) {
    mark();
    rename(glstate::Category::depth_stencil, ids.depth_stencil);
    if (by != GL_BLEND) return;
    keep_shares();
    rename(glstate::Category::color_buffer, ids.color_buffer);
}

void MarkingState::mark() {
    el::stencil_test::ref(state_) = 1;
    for (unsigned face = 0; face < 2; ++face) {
        el::stencil_func::ref(state_, face) = {GL_ALWAYS, 1, 0xff};
        el::stencil_op::ref(state_, face) = {GL_KEEP, GL_KEEP, GL_REPLACE};
        el::stencil_mask::ref(state_, face) = 0xff;
    }
}

void MarkingState::keep_shares() {
    glstate::BlendFunc& func = el::blend_func::ref(state_);
    const auto [source, destination] = alpha_of_shares(func);
    func.src_alpha = source;
    func.dst_alpha = destination;
    el::blend_equation::ref(state_).alpha = GL_FUNC_ADD;
}

void MarkingState::rename(glstate::Category category, Ids::Pair& ids) {
    const auto own = state_.ids[static_cast<std::size_t>(category)];
    if (ids.own != own) ids = {own, glstate::next_value_id()};
    state_.ids.take(static_cast<std::size_t>(category), ids.marking);
}

void MarkingState::restore(glstate::Category category, const Ids::Pair& ids) {
    state_.ids.take(static_cast<std::size_t>(category), ids.own);
}

MarkingState::~MarkingState() {
    state_.depth_stencil = own_;
    restore(glstate::Category::depth_stencil, ids_.depth_stencil);
    if (by_ != GL_BLEND) return;
    el::blend_func::ref(state_) = own_func_;
    el::blend_equation::ref(state_) = own_equation_;
    restore(glstate::Category::color_buffer, ids_.color_buffer);
}

}  // namespace wall::client
