// SPDX-License-Identifier: MIT
// Sampler objects: the errors of the specification, and what the program gets back.
#include <array>

#include "client_lib/objects/sampler.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class Samplers : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        gl().GenSamplers(c, 1, &sampler);
    }
    GLint parameter(GLenum pname) {
        GLint value = -1;
        gl().GetSamplerParameteriv(c, sampler, pname, &value);
        return value;
    }
    GLenum error_of(GLenum pname, GLint value) {
        gl().SamplerParameteri(c, sampler, pname, value);
        return error();
    }
    GLuint sampler = 0;
};

TEST_F(Samplers, BeginAsTexturesDo) {
    EXPECT_TRUE(gl().IsSampler(c, sampler));
    EXPECT_EQ(parameter(GL_TEXTURE_WRAP_S), GL_REPEAT);
    EXPECT_EQ(parameter(GL_TEXTURE_MIN_FILTER), GL_NEAREST_MIPMAP_LINEAR);
    EXPECT_EQ(parameter(GL_TEXTURE_MAG_FILTER), GL_LINEAR);
    EXPECT_EQ(parameter(GL_TEXTURE_MIN_LOD), -1000);
    EXPECT_EQ(parameter(GL_TEXTURE_MAX_LOD), 1000);
    EXPECT_EQ(parameter(GL_TEXTURE_COMPARE_FUNC), GL_LEQUAL);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(Samplers, KeepWhatTheyAreGivenInEveryForm) {
    gl().SamplerParameteri(c, sampler, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    EXPECT_EQ(parameter(GL_TEXTURE_WRAP_T), GL_CLAMP_TO_EDGE);
    gl().SamplerParameterf(c, sampler, GL_TEXTURE_LOD_BIAS, 1.5f);
    GLfloat bias = 0;
    gl().GetSamplerParameterfv(c, sampler, GL_TEXTURE_LOD_BIAS, &bias);
    EXPECT_EQ(bias, 1.5f);
    const GLint whole[4] = {-5, 1, 2147483647, 0};
    GLint back[4] = {};
    gl().SamplerParameterIiv(c, sampler, GL_TEXTURE_BORDER_COLOR, whole);
    gl().GetSamplerParameterIiv(c, sampler, GL_TEXTURE_BORDER_COLOR, back);
    EXPECT_TRUE(std::equal(whole, whole + 4, back));
    const GLint fractions[4] = {2147483647, 0, -2147483647, 0};
    GLfloat real[4] = {};
    gl().SamplerParameteriv(c, sampler, GL_TEXTURE_BORDER_COLOR, fractions);
    gl().GetSamplerParameterfv(c, sampler, GL_TEXTURE_BORDER_COLOR, real);
    EXPECT_EQ(real[0], 1);
    EXPECT_EQ(real[2], -1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(Samplers, RefuseWhatThereIsNot) {
    EXPECT_EQ(error_of(GL_TEXTURE_WRAP_S, GL_LINEAR), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(error_of(GL_TEXTURE_BASE_LEVEL, 1), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(error_of(GL_TEXTURE_BORDER_COLOR, 1), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(error_of(GL_TEXTURE_MAX_ANISOTROPY_EXT, 0), GLenum{GL_INVALID_VALUE});
    gl().SamplerParameteri(c, 77, GL_TEXTURE_WRAP_S, GL_REPEAT);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindSampler(c, 0, 77);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindSampler(c, 1000, sampler);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(Samplers, LeaveTheirUnitsWhenTheyAreDeleted) {
    gl().BindSampler(c, 1, sampler);
    gl().ActiveTexture(c, GL_TEXTURE1);
    GLint bound = -1;
    gl().GetIntegerv(c, GL_SAMPLER_BINDING, &bound);
    EXPECT_EQ(bound, static_cast<GLint>(sampler));
    gl().DeleteSamplers(c, 1, &sampler);
    gl().GetIntegerv(c, GL_SAMPLER_BINDING, &bound);
    EXPECT_EQ(bound, 0);
    EXPECT_FALSE(gl().IsSampler(c, sampler));
    EXPECT_TRUE(share->by_id.empty());
}

TEST_F(Samplers, TellNodesWhatTheyLack) {
    Sampler made(1);
    wire::PackBuffer all, none, some;
    made.pack_changes(0, all, no_limit);
    EXPECT_EQ(all.commands(), 1u) << "the name exists";
    const auto known = made.latest();
    EXPECT_FALSE(made.set(GL_TEXTURE_LOD_BIAS, made.get(GL_TEXTURE_LOD_BIAS)));
    made.pack_changes(known, none, no_limit);
    EXPECT_EQ(none.commands(), 0u);
    EXPECT_TRUE(made.set(GL_TEXTURE_LOD_BIAS, {GL_FLOAT, {1, 0, 0, 0}}));
    made.pack_changes(known, some, no_limit);
    EXPECT_EQ(some.commands(), 1u);
}

}  // namespace
}  // namespace wall::client
