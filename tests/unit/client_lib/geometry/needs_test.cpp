// SPDX-License-Identifier: MIT
#include "client_lib/geometry/needs.h"

#include <gtest/gtest.h>

#include "common/glstate/modelview.h"

namespace wall::client {
namespace {

using glstate::Category;
using glstate::mask_of;

constexpr auto kOrigin = mask_of(Category::modelview_origin);

glstate::Mat4 moved(float x) {
    glstate::Mat4 m;
    m[12] = x;
    return m;
}

void set_matrix(glstate::State& state, const glstate::Mat4& m) { glstate::assign<glstate::el::modelview>(state, 0, m); }
void set_origin(glstate::State& state, const glstate::Mat4& of) {
    glstate::assign<glstate::el::modelview_form>(state, 0, {2, glstate::modelview_tag(of)});
}

TEST(Needs, ALitBlockNeedsTheOriginOfItsMatrix) {
    glstate::State mirror, state;
    set_matrix(state, moved(1));
    set_origin(state, moved(1));
    EXPECT_TRUE(categories_to_send({}, mirror, state) & kOrigin);
}

TEST(Needs, TheOriginOfAnEarlierMatrixWaits) {
    glstate::State mirror, state;
    set_origin(state, moved(1));
    set_matrix(state, moved(2));
    EXPECT_FALSE(categories_to_send({}, mirror, state) & kOrigin);
    EXPECT_EQ(categories_to_send({}, mirror, state) | kOrigin, glstate::kSentCategories);
}

TEST(Needs, ButNotIfTheNodeWouldTakeItsOwnForThisMatrix) {
    glstate::State mirror, state;
    set_origin(mirror, moved(2));
    set_origin(state, moved(1));
    set_matrix(state, moved(2));
    EXPECT_TRUE(categories_to_send({}, mirror, state) & kOrigin);
}

TEST(Needs, UnlitGeometryNeedsNeitherNormalsNorLights) {
    glstate::State state;
    const Needs unlit = needs_of_geometry(state);
    EXPECT_TRUE(unlit.waits(Attribute::normal));
    EXPECT_FALSE(unlit.categories & (kOrigin | mask_of(Category::lights) | mask_of(Category::material)));
    glstate::assign<glstate::el::lighting_enabled>(state, 0, true);
    const Needs lit = needs_of_geometry(state);
    EXPECT_FALSE(lit.waits(Attribute::normal));
    EXPECT_TRUE(lit.categories & mask_of(Category::lights));
}

}  // namespace
}  // namespace wall::client
