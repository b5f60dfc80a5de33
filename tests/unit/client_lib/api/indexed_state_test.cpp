// SPDX-License-Identifier: MIT
// State of single draw buffers: what is set for all, what for one, and what glGet answers.
#include <array>

#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class IndexedState : public ContextTest {
protected:
    std::array<GLboolean, 4> mask_of(GLuint buffer) {
        std::array<GLboolean, 4> mask{};
        gl().GetBooleani_v(c, GL_COLOR_WRITEMASK, buffer, mask.data());
        return mask;
    }
    GLint integer(GLenum word) {
        GLint value = -1;
        gl().GetIntegerv(c, word, &value);
        return value;
    }
};

TEST_F(IndexedState, AWordForAllBuffersSetsEachOfThem) {
    gl().Enable(c, GL_BLEND);
    for (GLuint i = 0; i < 8; ++i) EXPECT_TRUE(gl().IsEnabledi(c, GL_BLEND, i)) << i;
    gl().Disablei(c, GL_BLEND, 0);
    EXPECT_FALSE(gl().IsEnabled(c, GL_BLEND)) << "the first one's";
    EXPECT_TRUE(gl().IsEnabledi(c, GL_BLEND, 7));
    EXPECT_EQ(integer(GL_BLEND), 0);
    gl().Disable(c, GL_BLEND);
    gl().Enablei(c, GL_BLEND, 0);
    EXPECT_TRUE(gl().IsEnabled(c, GL_BLEND));
    EXPECT_FALSE(gl().IsEnabledi(c, GL_BLEND, 1));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(IndexedState, BlendingIsOfSingleBuffers) {
    const auto of = [&](GLenum word, GLuint buffer) {
        GLint value = -1;
        gl().GetIntegeri_v(c, word, buffer, &value);
        return static_cast<GLenum>(value);
    };
    gl().BlendFuncSeparatei(c, 1, GL_ZERO, GL_ZERO, GL_ZERO, GL_ZERO);
    EXPECT_EQ(of(GL_BLEND_SRC_RGB, 0), GLenum{GL_ONE});
    EXPECT_EQ(of(GL_BLEND_SRC_RGB, 1), GLenum{GL_ZERO});
    gl().BlendFuncSeparatei(c, 0, GL_DST_COLOR, GL_ZERO, GL_ONE, GL_ONE);
    EXPECT_EQ(of(GL_BLEND_SRC_RGB, 0), GLenum{GL_DST_COLOR});
    EXPECT_EQ(of(GL_BLEND_SRC_RGB, 1), GLenum{GL_ZERO});
    EXPECT_EQ(of(GL_BLEND_SRC_RGB, 2), GLenum{GL_ONE}) << "as it was for all";
    gl().BlendFuncSeparate(c, GL_ONE, GL_ONE, GL_ONE, GL_ONE);
    for (GLuint i = 0; i < 8; ++i) EXPECT_EQ(of(GL_BLEND_DST_ALPHA, i), GLenum{GL_ONE}) << i;
    gl().BlendEquationSeparatei(c, 7, GL_MIN, GL_MAX);
    EXPECT_EQ(of(GL_BLEND_EQUATION_ALPHA, 7), GLenum{GL_MAX});
    EXPECT_EQ(of(GL_BLEND_EQUATION_RGB, 6), GLenum{GL_FUNC_ADD});
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().BlendEquationSeparatei(c, 8, GL_MIN, GL_MAX);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BlendEquationSeparatei(c, 0, GL_ONE, GL_MAX);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(IndexedState, ColorMasksAreOfSingleBuffers) {
    gl().ColorMaski(c, 2, 0, 1, 0, 1);
    EXPECT_EQ(mask_of(2), (std::array<GLboolean, 4>{0, 1, 0, 1}));
    EXPECT_EQ(mask_of(1), (std::array<GLboolean, 4>{1, 1, 1, 1}));
    std::array<GLint, 4> first{};
    gl().GetIntegerv(c, GL_COLOR_WRITEMASK, first.data());
    EXPECT_EQ(first, (std::array<GLint, 4>{1, 1, 1, 1}));
    gl().ColorMask(c, 1, 0, 0, 0);
    EXPECT_EQ(mask_of(2), (std::array<GLboolean, 4>{1, 0, 0, 0}));
    std::array<GLint64, 4> long_mask{};
    gl().GetInteger64i_v(c, GL_COLOR_WRITEMASK, 7, long_mask.data());
    EXPECT_EQ(long_mask, (std::array<GLint64, 4>{1, 0, 0, 0}));
}

TEST_F(IndexedState, AttributesAreRestoredWithAllBuffers) {
    gl().Enablei(c, GL_BLEND, 3);
    gl().PushAttrib(c, GL_COLOR_BUFFER_BIT);
    gl().Enable(c, GL_BLEND);
    gl().ColorMaski(c, 1, 0, 0, 0, 0);
    gl().PopAttrib(c);
    EXPECT_TRUE(gl().IsEnabledi(c, GL_BLEND, 3));
    EXPECT_FALSE(gl().IsEnabledi(c, GL_BLEND, 2));
    EXPECT_EQ(mask_of(1), (std::array<GLboolean, 4>{1, 1, 1, 1}));
}

TEST_F(IndexedState, RefusesWhatThereIsNot) {
    gl().Enablei(c, GL_BLEND, 8);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().Enablei(c, GL_FOG, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().ColorMaski(c, 8, 1, 1, 1, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    GLint value = 7;
    gl().GetIntegeri_v(c, GL_COLOR_WRITEMASK, 8, &value);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().GetIntegeri_v(c, GL_FOG, 0, &value);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(value, 7);
}

}  // namespace
}  // namespace wall::client
