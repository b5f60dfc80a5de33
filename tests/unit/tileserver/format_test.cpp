// SPDX-License-Identifier: MIT
// What a node says of internal formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "common/glapi/format_words.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver {
namespace {

using Answers = std::array<GLint64, glapi::kFormatWords.size()>;

GLint64 of(const Answers& answers, GLenum word) {
    return answers[static_cast<std::size_t>(std::ranges::find(glapi::kFormatWords, word) -
                                            glapi::kFormatWords.begin())];
}

class FormatTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL";
        session_.emplace(*node_.node, SessionId(1));
    }
    Answers ask(GLenum target, GLenum format) {
        test::Batch batch;
        glapi::pack::FormatQuery(batch.buffer(), RequestId(7), target, format);
        session_->expect_run(batch);
        const auto& reply = session_->replies[RequestId(7)];
        Answers out{};
        EXPECT_EQ(reply.size(), sizeof out);
        if (reply.size() == sizeof out) std::memcpy(out.data(), reply.data(), sizeof out);
        return out;
    }

    test::TestNode node_;
    std::optional<test::TestSession> session_;
};

TEST_F(FormatTest, TheDriverAnswers) {
    const Answers colors = ask(GL_TEXTURE_2D, GL_RGBA8);
    EXPECT_EQ(of(colors, GL_INTERNALFORMAT_SUPPORTED), GL_TRUE);
    EXPECT_EQ(of(colors, GL_INTERNALFORMAT_RED_SIZE), 8);
    EXPECT_EQ(of(colors, GL_COLOR_RENDERABLE), GL_TRUE);
    EXPECT_EQ(of(colors, GL_VIEW_COMPATIBILITY_CLASS), GL_VIEW_CLASS_32_BITS);
    EXPECT_EQ(of(ask(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24), GL_DEPTH_RENDERABLE), GL_TRUE);
}

TEST_F(FormatTest, WhatIsNoneCanDoNothing) {
    EXPECT_EQ(ask(GL_TEXTURE_2D, GL_LINEAR), Answers{});
    EXPECT_EQ(ask(0x1234, GL_RGBA8), Answers{});
}

}  // namespace
}  // namespace wall::tileserver
