// SPDX-License-Identifier: MIT
// Attribute stacks, materials and colour material.
#include "client_lib/context/attribute_stack.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

using AttributesTest = ContextTest;

TEST_F(AttributesTest, PopRestoresWhatTheBitsName) {
    gl().PushAttrib(c, GL_ENABLE_BIT | GL_CURRENT_BIT);
    gl().Enable(c, GL_FOG);
    const GLfloat density = 0.25f;
    gl().Fogfv(c, GL_FOG_DENSITY, &density);
    glstate::assign<glstate::el::color>(c.state, 0, {0, 0, 1, 1});
    gl().PopAttrib(c);
    EXPECT_FALSE(c.state.fog.fog_enabled);
    EXPECT_EQ(c.state.fog.fog_density, 0.25f);  // of GL_FOG_BIT
    EXPECT_EQ(c.state.current.color, (glstate::Vec4{1, 1, 1, 1}));
}

TEST_F(AttributesTest, EqualCategoriesGetTheirValueIdsBack) {
    const auto before = c.state.ids;
    gl().PushAttrib(c, GL_ALL_ATTRIB_BITS);
    gl().Enable(c, GL_FOG);
    gl().LineWidth(c, 3);
    gl().PopAttrib(c);
    EXPECT_EQ(c.state.ids, before);
}

TEST_F(AttributesTest, MatricesAreNotSavedButTheModeIs) {
    gl().PushAttrib(c, GL_ALL_ATTRIB_BITS);
    gl().MatrixMode(c, GL_PROJECTION);
    gl().Translatef(c, 1, 0, 0);
    gl().PopAttrib(c);
    EXPECT_EQ(c.state.local.matrix_mode, GLenum{GL_MODELVIEW});
    EXPECT_EQ(c.state.matrix.projection[12], 1);
}

TEST_F(AttributesTest, Limits) {
    for (std::size_t i = 0; i < kAttributeStackLimit; ++i) gl().PushAttrib(c, GL_ALL_ATTRIB_BITS);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().PushAttrib(c, 0);
    EXPECT_EQ(error(), GLenum{GL_STACK_OVERFLOW});
    for (std::size_t i = 0; i < kAttributeStackLimit; ++i) gl().PopAttrib(c);
    gl().PopAttrib(c);
    EXPECT_EQ(error(), GLenum{GL_STACK_UNDERFLOW});
}

TEST_F(AttributesTest, TrackedMaterialsFollowTheColourUntilTheyAreFreed) {
    const GLfloat grey[4] = {0.5f, 0.5f, 0.5f, 1};
    GLfloat value[4];
    gl().Enable(c, GL_COLOR_MATERIAL);
    gl().Materialfv(c, GL_FRONT, GL_DIFFUSE, grey);  // no effect: it follows
    glstate::assign<glstate::el::color>(c.state, 0, {1, 0, 0, 1});
    gl().GetMaterialfv(c, GL_FRONT, GL_DIFFUSE, value);
    EXPECT_EQ(value[0], 1);
    EXPECT_EQ(value[1], 0);
    gl().Disable(c, GL_COLOR_MATERIAL);
    glstate::assign<glstate::el::color>(c.state, 0, {0, 1, 0, 1});
    gl().GetMaterialfv(c, GL_FRONT, GL_AMBIENT, value);
    EXPECT_EQ(value[0], 1);
    gl().GetMaterialfv(c, GL_FRONT_AND_BACK, GL_AMBIENT, value);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(AttributesTest, MaterialErrors) {
    const GLfloat big = 200;
    gl().Materialfv(c, GL_FRONT, GL_SHININESS, &big);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().Materialfv(c, GL_LEFT, GL_SHININESS, &big);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(AttributesTest, MatrixStackLimits) {
    for (int i = 0; i < 31; ++i) gl().PushMatrix(c);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().PushMatrix(c);
    EXPECT_EQ(error(), GLenum{GL_STACK_OVERFLOW});
    GLint depth = 0;
    gl().GetIntegerv(c, GL_MODELVIEW_STACK_DEPTH, &depth);
    EXPECT_EQ(depth, 32);
    gl().MatrixMode(c, GL_TEXTURE);
    gl().PopMatrix(c);
    EXPECT_EQ(error(), GLenum{GL_STACK_UNDERFLOW});
}

}  // namespace
}  // namespace wall::client
