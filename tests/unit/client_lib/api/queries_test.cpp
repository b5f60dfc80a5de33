// SPDX-License-Identifier: MIT
// Query objects and conditional rendering without a wall: the errors of the specification.
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class Queries : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        gl().GenQueries(c, 3, names);
    }
    GLenum error_of_begin(GLenum target, GLuint name) {
        gl().BeginQueryIndexed(c, target, 0, name);
        return error();
    }
    GLint current(GLenum target) {
        GLint name = -1;
        gl().GetQueryIndexediv(c, target, 0, GL_CURRENT_QUERY, &name);
        return name;
    }
    GLuint names[3] = {};
};

TEST_F(Queries, OneAboutSamplesIsCurrentAtATime) {
    EXPECT_EQ(error_of_begin(GL_ANY_SAMPLES_PASSED, names[0]), GLenum{GL_NO_ERROR});
    EXPECT_EQ(error_of_begin(GL_SAMPLES_PASSED, names[1]), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(error_of_begin(GL_PRIMITIVES_GENERATED, names[1]), GLenum{GL_NO_ERROR});
    EXPECT_EQ(current(GL_ANY_SAMPLES_PASSED), static_cast<GLint>(names[0]));
    EXPECT_EQ(current(GL_SAMPLES_PASSED), 0);
    gl().EndQueryIndexed(c, GL_SAMPLES_PASSED, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "of another target";
    gl().EndQueryIndexed(c, GL_ANY_SAMPLES_PASSED, 0);
    gl().EndQueryIndexed(c, GL_PRIMITIVES_GENERATED, 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(error_of_begin(GL_PRIMITIVES_GENERATED, names[0]), GLenum{GL_INVALID_OPERATION}) << "has a target";
    EXPECT_EQ(error_of_begin(GL_TIMESTAMP, names[2]), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(error_of_begin(GL_SAMPLES_PASSED, 0), GLenum{GL_INVALID_OPERATION});
}

TEST_F(Queries, PrimitivesAreCountedOfEachStream) {
    gl().BeginQueryIndexed(c, GL_PRIMITIVES_GENERATED, 1, names[0]);
    gl().BeginQueryIndexed(c, GL_PRIMITIVES_GENERATED, 3, names[1]);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(c.state.objects.primitives_query[0], 0u);
    EXPECT_NE(c.state.objects.primitives_query[1], 0u);
    GLint name = -1;
    gl().GetQueryIndexediv(c, GL_PRIMITIVES_GENERATED, 3, GL_CURRENT_QUERY, &name);
    EXPECT_EQ(name, static_cast<GLint>(names[1]));
    gl().EndQueryIndexed(c, GL_PRIMITIVES_GENERATED, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "none of this stream";
    gl().EndQueryIndexed(c, GL_PRIMITIVES_GENERATED, 1);
    EXPECT_EQ(c.state.objects.primitives_query[1], 0u);
    gl().BeginQueryIndexed(c, GL_PRIMITIVES_GENERATED, 4, names[2]);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BeginQueryIndexed(c, GL_SAMPLES_PASSED, 1, names[2]);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(Queries, CountersHaveTheirBits) {
    GLint bits = 0;
    gl().GetQueryIndexediv(c, GL_TIMESTAMP, 0, GL_QUERY_COUNTER_BITS, &bits);
    EXPECT_EQ(bits, 64);
    gl().GetQueryIndexediv(c, GL_ANY_SAMPLES_PASSED, 0, GL_QUERY_COUNTER_BITS, &bits);
    EXPECT_EQ(bits, 1);
}

TEST_F(Queries, AConditionIsAQueryThatHasEnded) {
    gl().EndConditionalRender(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BeginConditionalRender(c, 0, GL_QUERY_WAIT);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BeginConditionalRender(c, 99, GL_QUERY_WAIT);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BeginConditionalRender(c, names[0], GL_QUERY_WAIT);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "it was never begun";
    gl().BeginQueryIndexed(c, GL_SAMPLES_PASSED, 0, names[0]);
    gl().BeginConditionalRender(c, names[0], GL_FOG);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    gl().BeginConditionalRender(c, names[0], GL_QUERY_WAIT);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "it goes on";
    EXPECT_FALSE(c.draws_nothing);
}

}  // namespace
}  // namespace wall::client
