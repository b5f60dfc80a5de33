// SPDX-License-Identifier: MIT
// GL_KHR_debug: messages, groups, labels, and errors as messages.
#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

using testing::HasSubstr;

class DebugOutput : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        gl().Enable(c, GL_DEBUG_OUTPUT);
    }
    void insert(GLuint id, const char* text, GLenum severity = GL_DEBUG_SEVERITY_HIGH) {
        gl().DebugMessageInsert(c, GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, id, severity, -1, text);
    }
    /// The next message; empty: there is none.
    std::string read() {
        GLchar text[DebugLogText] = {};
        GLsizei length = 0;
        gl().GetDebugMessageLog(c, 1, sizeof text, nullptr, nullptr, nullptr, nullptr, &length, text);
        return text;
    }
    GLint integer(GLenum word) {
        GLint value = -1;
        gl().GetIntegerv(c, word, &value);
        return value;
    }
    static constexpr std::size_t DebugLogText = 4096;
};

TEST_F(DebugOutput, MessagesWaitToBeRead) {
    insert(1, "one");
    insert(2, "two");
    EXPECT_EQ(integer(GL_DEBUG_LOGGED_MESSAGES), 2);
    EXPECT_EQ(integer(GL_DEBUG_NEXT_LOGGED_MESSAGE_LENGTH), 4);
    GLchar small[6] = {};
    EXPECT_EQ(gl().GetDebugMessageLog(c, 9, sizeof small, nullptr, nullptr, nullptr, nullptr, nullptr, small), 1u)
        << "there is no room for the second";
    EXPECT_EQ(read(), "two");
    EXPECT_EQ(read(), "");
    for (GLuint i = 0; i < 20; ++i) insert(i, "many");
    EXPECT_EQ(integer(GL_DEBUG_LOGGED_MESSAGES), 10);
}

TEST_F(DebugOutput, NothingIsSaidWhileItIsOff) {
    gl().Disable(c, GL_DEBUG_OUTPUT);
    insert(1, "one");
    gl().Enable(c, 0x1234);
    EXPECT_EQ(read(), "");
}

TEST_F(DebugOutput, AnErrorSaysWhichCommandItIsOf) {
    gl().BlendFuncSeparate(c, GL_FRONT, GL_ONE, GL_ONE, GL_ONE);
    EXPECT_EQ(read(), "") << "while the command goes on, and holds mutexes that a callback's commands may want";
    c.tell_errors();
    EXPECT_THAT(read(), HasSubstr("GL_INVALID_ENUM in glBlendFuncSeparate"));
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM}) << "and is one as before";
}

TEST_F(DebugOutput, ACallbackIsCalledAtOnce) {
    struct Heard {
        GLenum severity;
        std::string text;
    };
    std::vector<Heard> heard;
    const auto callback = [](GLenum, GLenum, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                             const void* user) {
        static_cast<std::vector<Heard>*>(const_cast<void*>(user))
            ->push_back({severity, std::string(text, static_cast<std::size_t>(length))});
    };
    gl().DebugMessageCallback(c, callback, &heard);
    insert(1, "one");
    ASSERT_EQ(heard.size(), 1u);
    EXPECT_EQ(heard[0].text, "one");
    void* user = nullptr;
    gl().GetPointerv(c, GL_DEBUG_CALLBACK_USER_PARAM, &user);
    EXPECT_EQ(user, &heard);
    EXPECT_EQ(read(), "");
}

TEST_F(DebugOutput, ControlsChooseBySeverityAndId) {
    insert(1, "low", GL_DEBUG_SEVERITY_LOW);
    EXPECT_EQ(read(), "") << "off at first";
    gl().DebugMessageControl(c, GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_LOW, 0, nullptr, GL_TRUE);
    insert(1, "low", GL_DEBUG_SEVERITY_LOW);
    EXPECT_EQ(read(), "low");
    const GLuint ids[] = {5};
    gl().DebugMessageControl(c, GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, GL_DONT_CARE, 1, ids, GL_FALSE);
    insert(5, "five");
    insert(6, "six");
    EXPECT_EQ(read(), "six");
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().DebugMessageControl(c, GL_DONT_CARE, GL_DEBUG_TYPE_OTHER, GL_DONT_CARE, 1, ids, GL_FALSE);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "an id is of one source";
    gl().DebugMessageControl(c, GL_FOG, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(DebugOutput, AGroupKeepsItsControlsToItself) {
    gl().PushDebugGroup(c, GL_DEBUG_SOURCE_APPLICATION, 9, -1, "group");
    EXPECT_EQ(read(), "group");
    EXPECT_EQ(integer(GL_DEBUG_GROUP_STACK_DEPTH), 2);
    gl().DebugMessageControl(c, GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    insert(1, "inside");
    gl().PopDebugGroup(c);
    EXPECT_EQ(read(), "group");
    insert(1, "outside");
    EXPECT_EQ(read(), "outside");
    gl().PopDebugGroup(c);
    EXPECT_EQ(error(), GLenum{GL_STACK_UNDERFLOW});
    for (int i = 0; i < 63; ++i) gl().PushDebugGroup(c, GL_DEBUG_SOURCE_APPLICATION, 1, -1, "deep");
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().PushDebugGroup(c, GL_DEBUG_SOURCE_APPLICATION, 1, -1, "too deep");
    EXPECT_EQ(error(), GLenum{GL_STACK_OVERFLOW});
}

TEST_F(DebugOutput, LabelsGoWithTheirObjects) {
    GLuint sampler = 0;
    gl().GenSamplers(c, 1, &sampler);
    gl().ObjectLabel(c, GL_SAMPLER, sampler, -1, "smooth");
    GLchar text[32] = {};
    GLsizei length = -1;
    gl().GetObjectLabel(c, GL_SAMPLER, sampler, sizeof text, &length, text);
    EXPECT_STREQ(text, "smooth");
    EXPECT_EQ(length, 6);
    gl().GetObjectLabel(c, GL_SAMPLER, sampler, 4, &length, text);
    EXPECT_STREQ(text, "smo");
    EXPECT_EQ(length, 3);
    gl().ObjectLabel(c, GL_SAMPLER, sampler, 300, std::string(300, 'x').c_str());
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().ObjectLabel(c, GL_SAMPLER, 99, -1, "none");
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().ObjectLabel(c, GL_FOG, sampler, -1, "none");
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(DebugOutput, LabelsAreOfWhatTheContextHasForItself) {
    GLuint feedback = 0, pipeline = 0;
    gl().GenTransformFeedbacks(c, 1, &feedback);
    gl().GenProgramPipelines(c, 1, &pipeline);
    gl().ObjectLabel(c, GL_TRANSFORM_FEEDBACK, feedback, -1, "only a name so far");
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BindTransformFeedback(c, GL_TRANSFORM_FEEDBACK, feedback);
    gl().BindProgramPipeline(c, pipeline);
    for (const auto& [kind, name] : {std::pair{GL_TRANSFORM_FEEDBACK, feedback}, {GL_PROGRAM_PIPELINE, pipeline}}) {
        gl().ObjectLabel(c, static_cast<GLenum>(kind), name, -1, "mine");
        GLchar text[32] = {};
        gl().GetObjectLabel(c, static_cast<GLenum>(kind), name, sizeof text, nullptr, text);
        EXPECT_STREQ(text, "mine");
    }
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

}  // namespace
}  // namespace wall::client
