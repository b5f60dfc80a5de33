// SPDX-License-Identifier: MIT
// Where a context's vertices go: by the matrices of fixed function, or by a program whose position was recognised.
#include "client_lib/objects/program.h"

#include <cstring>
#include <limits>

#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

using glapi::PositionOp;

/// gl_Position = vec4(place, 1.0) + shift
glapi::ProgramReflection shifting(const std::string& attribute, std::int32_t location) {
    glapi::ProgramReflection r;
    r.linked = true;
    r.uniforms = {{GL_FLOAT, 1, false, false, "unused", {0}},
                  {GL_FLOAT_VEC4, 2, false, true, "shift", {0, 0, 0, 0, 0, 0, 0, 0}}};
    r.attributes = {{GL_FLOAT_VEC4, 1, location, attribute}};
    r.position = {
        {{"shift", 1}},
        attribute,
        true,
        {{PositionOp::attribute, 1, 4, {}}, {PositionOp::uniform, 1, 4, {0}}, {PositionOp::add, 1, 4, {0, 1}}}};
    return r;
}

class PlacingTest : public ContextTest {
protected:
    void use(glapi::ProgramReflection reflection) {
        c.program = std::make_shared<Program>(ClientName(1), 1);
        c.program->executable = Executable::make({}, std::move(reflection));
    }
    void set_shift(float x) {
        Executable& executable = *c.program->executable;
        const float values[] = {x, 0, 0, 0};
        std::uint32_t words[4];
        std::memcpy(words, values, sizeof words);
        executable.store(executable.uniforms[1], 1, words);
    }
};

TEST_F(PlacingTest, FixedFunctionIsAlwaysKnown) {
    EXPECT_TRUE(c.placing().of_vertices());
    EXPECT_TRUE(c.placing().homogeneous);
    glstate::Mat4 twice = glstate::kIdentity;
    twice[0] = 2;
    c.set<glstate::el::modelview>(0, twice);
    EXPECT_EQ(c.placing().projection.clip_from_object[0], 2);
    EXPECT_TRUE(c.placing().projection.near_plane);
    c.set<glstate::el::depth_clamp>(0, 1);
    EXPECT_FALSE(c.placing().projection.near_plane);
}

TEST_F(PlacingTest, AProgramIsFollowedByItsUniforms) {
    use(shifting("place", 3));
    EXPECT_TRUE(c.placing().known);
    EXPECT_FALSE(c.placing().of_vertices());
    EXPECT_EQ(c.placing().attribute, 3u);
    EXPECT_TRUE(c.placing().homogeneous) << "as long as the uniform is 0";
    set_shift(5);
    EXPECT_FALSE(c.placing().homogeneous);
    EXPECT_EQ(c.placing().projection.clip_from_object[12], 5);
    set_shift(6);
    EXPECT_EQ(c.placing().projection.clip_from_object[12], 6);
    c.program = nullptr;
    EXPECT_EQ(c.placing().projection.clip_from_object, glstate::kIdentity);
}

TEST_F(PlacingTest, ThePositionMayBeAnAttributeOfNumberZero) {
    use(shifting("place", 0));
    EXPECT_TRUE(c.placing().of_vertices());
    use(shifting("gl_Vertex", -1));
    EXPECT_TRUE(c.placing().of_vertices());
}

TEST_F(PlacingTest, WhatWasNotRecognisedMayBeAnywhere) {
    const geom::Box box{_mm_setr_ps(1, 1, 1, 1), _mm_setr_ps(2, 2, 2, 1)};
    const auto unknown = [&](const glapi::ProgramReflection& reflection) {
        use(reflection);
        EXPECT_FALSE(c.placing().known);
        EXPECT_FALSE(project(c.placing().projection, box));
    };
    auto reflection = shifting("place", 3);
    reflection.position = {};
    unknown(reflection);
    unknown(shifting("gl_Normal", -1));  // an array that is no generic one
    reflection = shifting("place", 3);
    reflection.position.uniforms[0].element = 2;
    unknown(reflection);
    reflection.position.uniforms[0].name = "gone";
    unknown(reflection);
    use(shifting("place", 3));
    EXPECT_TRUE(c.placing().known);
    set_shift(std::numeric_limits<float>::infinity());
    EXPECT_FALSE(c.placing().known);
    set_shift(1);
    EXPECT_TRUE(c.placing().known);
}

TEST_F(PlacingTest, BlocksOfVerticesHaveBoxesOnlyWhereTheyTellThePlace) {
    const auto box_of = [&](float w) {
        gl().Begin(c, GL_POINTS);
        gl().Vertex4f(c, 1, 2, 3, w);
        gl().End(c);
        const geom::Box box = c.packer.block_box();
        c.packer.reset();
        return box;
    };
    use(shifting("gl_Vertex", -1));
    EXPECT_FALSE(box_of(1).unbounded());
    EXPECT_FALSE(box_of(2).unbounded());
    set_shift(1);
    EXPECT_FALSE(box_of(1).unbounded());
    EXPECT_TRUE(box_of(2).unbounded()) << "multiples of a vertex are in other places";
    EXPECT_FALSE(box_of(1).unbounded());
    use(shifting("place", 3));
    EXPECT_TRUE(box_of(1).unbounded());
}

}  // namespace
}  // namespace wall::client
