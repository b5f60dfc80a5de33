// SPDX-License-Identifier: MIT
// What is said of internal formats, as far as no node need be asked.
#include <algorithm>

#include "common/glapi/format_words.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class InternalFormats : public ContextTest {
protected:
    GLint of(GLenum target, GLenum format, GLenum word, GLsizei room = 1) {
        GLint value = -99;
        gl().GetInternalformativ(c, target, format, word, room, &value);
        return value;
    }
    /// As if a node had said so of each word: its place in the list.
    void answer(GLenum target, GLenum format) {
        auto& values = share->format_answers[{target, format}];
        for (std::size_t i = 0; i < glapi::kFormatWords.size(); ++i) values.push_back(static_cast<GLint64>(i));
    }
    GLint place_of(GLenum word) {
        return static_cast<GLint>(std::ranges::find(glapi::kFormatWords, word) - glapi::kFormatWords.begin());
    }
};

TEST_F(InternalFormats, AreWhatANodeSaid) {
    answer(GL_TEXTURE_2D, GL_RGBA8);
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_RGBA8, GL_INTERNALFORMAT_SUPPORTED), place_of(GL_INTERNALFORMAT_SUPPORTED));
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_RGBA8, GL_VIEW_COMPATIBILITY_CLASS), place_of(GL_VIEW_COMPATIBILITY_CLASS));
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_RGBA8, GL_MAX_WIDTH, 0), -99) << "there is no room";
    share->format_answers[{GL_TEXTURE_2D, GL_RGBA8}][static_cast<std::size_t>(place_of(GL_MAX_COMBINED_DIMENSIONS))] =
        GLint64{1} << 40;
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_RGBA8, GL_MAX_COMBINED_DIMENSIONS), 2147483647);
    GLint64 dimensions = 0;
    gl().GetInternalformati64v(c, GL_TEXTURE_2D, GL_RGBA8, GL_MAX_COMBINED_DIMENSIONS, 1, &dimensions);
    EXPECT_EQ(dimensions, GLint64{1} << 40);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(InternalFormats, ThatTheClientDoesNotKnowCanDoNothing) {
    answer(GL_RENDERBUFFER, GL_COMPRESSED_RGBA);
    EXPECT_EQ(of(GL_RENDERBUFFER, GL_COMPRESSED_RGBA, GL_COLOR_RENDERABLE), 0) << "nothing is drawn to it";
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_LINEAR, GL_INTERNALFORMAT_SUPPORTED), 0);
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_RGBA8, GL_NUM_SAMPLE_COUNTS), 0) << "a texel has one sample";
    EXPECT_EQ(of(GL_TEXTURE_2D_MULTISAMPLE, GL_RGBA8, GL_NUM_SAMPLE_COUNTS), 1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(InternalFormats, BlocksHaveTheBitsThatLevelsOfTexturesSay) {
    answer(GL_TEXTURE_2D, GL_COMPRESSED_RGB);
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_COMPRESSED_RGB, GL_INTERNALFORMAT_GREEN_SIZE), 4);
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_COMPRESSED_RGB, GL_INTERNALFORMAT_GREEN_TYPE),
              place_of(GL_INTERNALFORMAT_GREEN_TYPE));
    share->format_answers[{GL_TEXTURE_2D, GL_COMPRESSED_RGB}].assign(glapi::kFormatWords.size(), 0);
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_COMPRESSED_RGB, GL_INTERNALFORMAT_GREEN_SIZE), 0) << "the node has none";
}

TEST_F(InternalFormats, WhatIsOnlySampledHasNoTexturesOfSeveralSamples) {
    answer(GL_TEXTURE_2D, GL_RGB9_E5);
    answer(GL_TEXTURE_2D_MULTISAMPLE, GL_RGB9_E5);
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_RGB9_E5, GL_INTERNALFORMAT_RED_SIZE), place_of(GL_INTERNALFORMAT_RED_SIZE));
    EXPECT_EQ(of(GL_TEXTURE_2D_MULTISAMPLE, GL_RGB9_E5, GL_INTERNALFORMAT_RED_SIZE), 0);
}

TEST_F(InternalFormats, WordsThatAreNoneAreErrors) {
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_RGBA8, GL_TEXTURE_WIDTH), -99);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(of(GL_FRAMEBUFFER, GL_RGBA8, GL_SAMPLES), -99);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(of(GL_TEXTURE_2D, GL_RGBA8, GL_MAX_WIDTH, -1), -99);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

}  // namespace
}  // namespace wall::client
