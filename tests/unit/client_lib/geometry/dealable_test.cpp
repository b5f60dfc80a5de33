// SPDX-License-Identifier: MIT
#include "client_lib/geometry/dealable.h"

#include <gtest/gtest.h>

#include "common/glstate/value_ids.h"

namespace wall::client {
namespace {

namespace el = glstate::el;
constexpr auto kCategory = static_cast<std::size_t>(glstate::Category::depth_stencil);
constexpr auto kColors = static_cast<std::size_t>(glstate::Category::color_buffer);

template <class E>
std::optional<std::uint32_t> with(const typename E::type& value) {
    glstate::State state;
    el::depth_test::ref(state) = 1;
    E::ref(state) = value;
    return composed_by(state, false);
}

constexpr glstate::BlendFunc kOver{GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA};

glstate::State blending(const glstate::BlendFunc& func = kOver) {
    glstate::State state;
    el::blend_enabled::ref(state) = 1;
    el::blend_func::ref(state) = func;
    return state;
}

TEST(WhatIsDealt, IsComposedByItsDepthFunction) {
    EXPECT_EQ(with<el::depth_test>(1), GL_LESS);
    for (const std::uint32_t func : {GL_LESS, GL_LEQUAL, GL_GREATER, GL_GEQUAL})
        EXPECT_EQ(with<el::depth_func>(func), func);
}

TEST(WhatIsDealt, LeavesNothingOfWhatWasThere) {
    for (const std::uint32_t func : {GL_ALWAYS, GL_NEVER, GL_EQUAL, GL_NOTEQUAL})
        EXPECT_FALSE(with<el::depth_func>(func));
    EXPECT_FALSE(composed_by(glstate::State{}, false)) << "no depth test";
    EXPECT_FALSE(with<el::depth_mask>(0));
    EXPECT_FALSE(with<el::blend_enabled>(1));
    EXPECT_TRUE(with<el::blend_enabled>(2)) << "of a draw buffer that a window does not have";
    EXPECT_FALSE(with<el::color_logic_op>(1));
    EXPECT_FALSE(with<el::color_mask>({255, 255, 254, 255}));
    EXPECT_FALSE(with<el::stencil_test>(1));
    EXPECT_FALSE(with<el::draw_buffer>(GL_FRONT));
    EXPECT_FALSE(with<el::occlusion_query>(7));
    EXPECT_FALSE(with<el::capture>(7));
}

TEST(WhatIsDealt, MayLeaveAShareOfWhatWasThere) {
    EXPECT_EQ(composed_by(blending(), false), GLenum{GL_BLEND});
    EXPECT_EQ(composed_by(blending({GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA}), true),
              GLenum{GL_BLEND});
    EXPECT_EQ(composed_by(blending({GL_SRC_COLOR, GL_ONE, GL_ZERO, GL_ONE}), true), GLenum{GL_BLEND});
    EXPECT_FALSE(composed_by(blending(), true)) << "its alpha is no share";
    for (const std::uint32_t source : {GL_DST_COLOR, GL_ONE_MINUS_DST_ALPHA, GL_SRC_ALPHA_SATURATE, GL_SRC1_COLOR})
        EXPECT_FALSE(composed_by(blending({source, GL_ONE, GL_ONE, GL_ONE}), false)) << source;
    for (const std::uint32_t left : {GL_ZERO, GL_SRC_COLOR, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_COLOR, GL_DST_ALPHA})
        EXPECT_FALSE(composed_by(blending({GL_ONE, left, GL_ONE, GL_ONE}), false)) << left;
    auto state = blending();
    el::depth_test::ref(state) = 1;
    EXPECT_FALSE(composed_by(state, false)) << "others know the depths";
    state = blending();
    el::blend_equation::ref(state) = {GL_MAX, GL_FUNC_ADD};
    EXPECT_FALSE(composed_by(state, false));
    state = blending();
    el::framebuffer_srgb::ref(state) = 1;
    EXPECT_FALSE(composed_by(state, false)) << "blends by other values than are kept";
}

TEST(AMarkingState, KeepsWhatIsLeftInAlpha) {
    MarkingState::Ids ids;
    auto state = blending();
    el::blend_equation::ref(state).alpha = GL_MIN;
    state.ids.renew(kColors);
    const auto own = state.ids[kColors];
    std::uint64_t first = 0;
    {
        const MarkingState marking(state, GL_BLEND, ids);
        first = state.ids[kColors];
        EXPECT_NE(first, own);
        EXPECT_EQ(el::blend_func::ref(state),
                  (glstate::BlendFunc{GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA}));
        EXPECT_EQ(el::blend_equation::ref(state), (glstate::BlendEquation{GL_FUNC_ADD, GL_FUNC_ADD}));
    }
    EXPECT_EQ(state.ids[kColors], own);
    EXPECT_EQ(el::blend_func::ref(state), kOver);
    EXPECT_EQ(el::blend_equation::ref(state).alpha, GLenum{GL_MIN});
    {
        const MarkingState again(state, GL_BLEND, ids);
        EXPECT_EQ(state.ids[kColors], first);
    }
    auto adding = blending({GL_SRC_ALPHA, GL_ONE, GL_ONE, GL_ONE});
    const MarkingState marking(adding, GL_BLEND, ids);
    EXPECT_EQ(el::blend_func::ref(adding), (glstate::BlendFunc{GL_SRC_ALPHA, GL_ONE, GL_ZERO, GL_ONE}));
}

TEST(AMarkingState, HasTheSameIdForTheSameState) {
    glstate::State state;
    state.ids.renew(kCategory);
    const auto own = state.ids[kCategory];
    MarkingState::Ids ids;
    std::uint64_t first = 0;
    {
        const MarkingState marking(state, GL_LESS, ids);
        first = state.ids[kCategory];
        EXPECT_NE(first, own);
        EXPECT_EQ(el::stencil_test::ref(state), 1u);
        EXPECT_EQ(el::stencil_op::ref(state, 1).depth_pass, GLenum{GL_REPLACE});
    }
    EXPECT_EQ(state.ids[kCategory], own);
    EXPECT_EQ(el::stencil_test::ref(state), 0u);
    {
        const MarkingState again(state, GL_LESS, ids);
        EXPECT_EQ(state.ids[kCategory], first);
    }
    el::depth_func::ref(state) = GL_LEQUAL;
    state.ids.renew(kCategory);
    const MarkingState other(state, GL_LESS, ids);
    EXPECT_NE(state.ids[kCategory], first);
    EXPECT_EQ(el::depth_func::ref(state), GLenum{GL_LEQUAL});
}

}  // namespace
}  // namespace wall::client
