// SPDX-License-Identifier: MIT
#include "client_lib/geometry/dealable.h"

#include <gtest/gtest.h>

#include "common/glstate/value_ids.h"

namespace wall::client {
namespace {

namespace el = glstate::el;
constexpr auto kCategory = static_cast<std::size_t>(glstate::Category::depth_stencil);

template <class E>
std::optional<std::uint32_t> with(const typename E::type& value) {
    glstate::State state;
    el::depth_test::ref(state) = 1;
    E::ref(state) = value;
    return composed_by(state);
}

TEST(WhatIsDealt, IsComposedByItsDepthFunction) {
    EXPECT_EQ(with<el::depth_test>(1), GL_LESS);
    for (const std::uint32_t func : {GL_LESS, GL_LEQUAL, GL_GREATER, GL_GEQUAL})
        EXPECT_EQ(with<el::depth_func>(func), func);
}

TEST(WhatIsDealt, LeavesNothingOfWhatWasThere) {
    for (const std::uint32_t func : {GL_ALWAYS, GL_NEVER, GL_EQUAL, GL_NOTEQUAL})
        EXPECT_FALSE(with<el::depth_func>(func));
    EXPECT_FALSE(composed_by(glstate::State{})) << "no depth test";
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

TEST(AMarkingState, HasTheSameIdForTheSameState) {
    glstate::State state;
    state.ids.renew(kCategory);
    const auto own = state.ids[kCategory];
    MarkingState::Ids ids;
    std::uint64_t first = 0;
    {
        const MarkingState marking(state, ids);
        first = state.ids[kCategory];
        EXPECT_NE(first, own);
        EXPECT_EQ(el::stencil_test::ref(state), 1u);
        EXPECT_EQ(el::stencil_op::ref(state, 1).depth_pass, GLenum{GL_REPLACE});
    }
    EXPECT_EQ(state.ids[kCategory], own);
    EXPECT_EQ(el::stencil_test::ref(state), 0u);
    {
        const MarkingState again(state, ids);
        EXPECT_EQ(state.ids[kCategory], first);
    }
    el::depth_func::ref(state) = GL_LEQUAL;
    state.ids.renew(kCategory);
    const MarkingState other(state, ids);
    EXPECT_NE(state.ids[kCategory], first);
    EXPECT_EQ(el::depth_func::ref(state), GLenum{GL_LEQUAL});
}

}  // namespace
}  // namespace wall::client
