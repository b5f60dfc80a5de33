// SPDX-License-Identifier: MIT
// What a block leaves behind, in the context's state and in the mirror of a node that ran it.
#include "client_lib/geometry/fold.h"

#include <gtest/gtest.h>

#include <cstring>

#include "common/glstate/diff.h"

namespace wall::client {
namespace {

using glstate::Category;

class Fold : public testing::Test {
protected:
    void color(float red) {
        const float value[4] = {red, 0, 0, 1};
        std::memcpy(packer.append_attribute(Attribute::color, glapi::Op::Color4f, sizeof value), value, sizeof value);
    }
    static std::uint64_t id(const glstate::State& of, Category category) {
        return of.ids[static_cast<std::size_t>(category)];
    }

    Packer packer;
    glstate::State state, mirror;
};

TEST_F(Fold, NothingChangesNothing) {
    fold_block(packer, state);
    EXPECT_EQ(state.ids, glstate::State{}.ids);
}

TEST_F(Fold, TheLastAttributesStay) {
    color(0.25f);
    color(0.5f);
    fold_block(packer, state);
    EXPECT_EQ(state.current.color[0], 0.5f);
    EXPECT_NE(id(state, Category::current), id(mirror, Category::current));
}

TEST_F(Fold, MaterialsStayToo) {
    packer.materials.push_back({GL_FRONT, GL_SHININESS, {7}});
    packer.materials.push_back({GL_FRONT, GL_SHININESS, {9}});
    fold_block(packer, state);
    EXPECT_EQ(state.material.material_shininess[0], 9);
    EXPECT_NE(id(state, Category::material), id(mirror, Category::material));
}

TEST_F(Fold, AMirrorThatRanTheBlockHasTheSameAndIsKnownToHaveIt) {
    color(0.5f);
    packer.materials.push_back({GL_FRONT, GL_SHININESS, {7}});
    fold_block(packer, state);
    fold_block(packer, mirror, state);
    EXPECT_EQ(mirror.current.color, state.current.color);
    EXPECT_EQ(mirror.material.material_shininess[0], 7);
    EXPECT_EQ(mirror.ids, state.ids);
}

TEST_F(Fold, AMirrorThatWasBehindBeforeTheBlockStaysDifferent) {
    state.current.normal = {0, 1, 0};
    state.ids.renew(static_cast<std::size_t>(Category::current));
    color(0.5f);
    fold_block(packer, state);
    fold_block(packer, mirror, state);
    EXPECT_EQ(mirror.current.color, state.current.color);
    EXPECT_NE(id(mirror, Category::current), id(state, Category::current));
}

TEST_F(Fold, AnEmptiedPackerLeavesNothing) {
    color(0.5f);
    packer.materials.push_back({GL_FRONT, GL_SHININESS, {7}});
    packer.reset();
    fold_block(packer, state);
    EXPECT_EQ(state.ids, glstate::State{}.ids);
}

}  // namespace
}  // namespace wall::client
