// SPDX-License-Identifier: MIT
// Vertex array objects: what belongs to them, what becomes of names and of deleted buffers, and how they go with
// glPushClientAttrib.
#include "client_lib/context/vertex_array_objects.h"

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/vertex_inputs.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class VertexArrayObjectsTest : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        gl().GenVertexArrays(c, 2, objects);
        gl().GenBuffers(c, 3, buffers);
        for (const GLuint name : buffers) fill(name);
    }
    void fill(GLuint name) {
        gl().BindBuffer(c, GL_ARRAY_BUFFER, name);
        gl().BufferData(c, GL_ARRAY_BUFFER, 1200, nullptr, GL_STATIC_DRAW);
    }
    void positions_in(GLuint buffer) {
        gl().BindBuffer(c, GL_ARRAY_BUFFER, buffer);
        gl().VertexPointer(c, 3, GL_FLOAT, 24, nullptr);
        gl().EnableClientState(c, GL_VERTEX_ARRAY);
    }
    GLint asked(GLenum word) {
        GLint value = -1;
        gl().GetIntegerv(c, word, &value);
        return value;
    }
    GLint name(GLuint object) { return static_cast<GLint>(object); }
    VertexInput* input(bool indexed = false) { return c.inputs->current(c.state, *c.buffers, *share, indexed); }

    GLuint objects[2] = {}, buffers[3] = {};
};

TEST_F(VertexArrayObjectsTest, AnObjectIsThereWhenItsNameWasBound) {
    EXPECT_NE(objects[0], 0u);
    EXPECT_FALSE(gl().IsVertexArray(c, objects[0]));
    gl().BindVertexArray(c, objects[0]);
    EXPECT_TRUE(gl().IsVertexArray(c, objects[0]));
    EXPECT_EQ(asked(GL_VERTEX_ARRAY_BINDING), name(objects[0]));
    gl().BindVertexArray(c, 0);
    EXPECT_TRUE(gl().IsVertexArray(c, objects[0]));
    EXPECT_FALSE(gl().IsVertexArray(c, 0));
    EXPECT_EQ(asked(GL_VERTEX_ARRAY_BINDING), 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(VertexArrayObjectsTest, Errors) {
    gl().GenVertexArrays(c, -1, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().DeleteVertexArrays(c, -1, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BindVertexArray(c, objects[1] + 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "not a name that was generated";
    gl().DeleteVertexArrays(c, 1, &objects[0]);
    gl().BindVertexArray(c, objects[0]);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "deleted";
    const GLuint others[] = {0, 77};
    gl().DeleteVertexArrays(c, 2, others);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR}) << "are ignored";
}

TEST_F(VertexArrayObjectsTest, ArraysAndTheBufferOfIndicesBelongToIt) {
    positions_in(buffers[0]);
    gl().BindBuffer(c, GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    gl().BindVertexArray(c, objects[0]);
    EXPECT_FALSE(gl().IsEnabled(c, GL_VERTEX_ARRAY));
    EXPECT_EQ(asked(GL_ELEMENT_ARRAY_BUFFER_BINDING), 0);
    EXPECT_EQ(asked(GL_VERTEX_ARRAY_SIZE), 4) << "the initial value";
    EXPECT_EQ(asked(GL_ARRAY_BUFFER_BINDING), name(buffers[0])) << "not a part of it";
    gl().ClientActiveTexture(c, GL_TEXTURE2);
    gl().EnableClientState(c, GL_TEXTURE_COORD_ARRAY);
    gl().EnableVertexAttribArray(c, 5);
    gl().BindBuffer(c, GL_ELEMENT_ARRAY_BUFFER, buffers[2]);

    gl().BindVertexArray(c, 0);
    EXPECT_TRUE(gl().IsEnabled(c, GL_VERTEX_ARRAY));
    EXPECT_FALSE(gl().IsEnabled(c, GL_TEXTURE_COORD_ARRAY));
    EXPECT_EQ(asked(GL_CLIENT_ACTIVE_TEXTURE), GL_TEXTURE2) << "not a part of it";
    EXPECT_EQ(asked(GL_ELEMENT_ARRAY_BUFFER_BINDING), name(buffers[1]));
    gl().BindVertexArray(c, objects[0]);
    EXPECT_TRUE(gl().IsEnabled(c, GL_TEXTURE_COORD_ARRAY));
    EXPECT_EQ(asked(GL_ELEMENT_ARRAY_BUFFER_BINDING), name(buffers[2]));
}

TEST_F(VertexArrayObjectsTest, BindingOneAgainFindsItsInput) {
    for (const int i : {0, 1}) {
        gl().BindVertexArray(c, objects[i]);
        positions_in(buffers[i]);
    }
    VertexInput* const second = input();
    gl().BindVertexArray(c, objects[0]);
    VertexInput* const first = input();
    ASSERT_TRUE(first && second);
    EXPECT_NE(first, second);
    gl().BindVertexArray(c, objects[1]);
    EXPECT_EQ(input(), second);
    gl().BindVertexArray(c, objects[0]);
    EXPECT_EQ(input(), first);
    gl().DisableClientState(c, GL_VERTEX_ARRAY);
    ASSERT_TRUE(input());
    EXPECT_TRUE(input()->definition().arrays.empty());
}

TEST_F(VertexArrayObjectsTest, TheBoundOneThatIsDeletedIsBoundNoMore) {
    positions_in(buffers[0]);
    gl().BindVertexArray(c, objects[0]);
    gl().DeleteVertexArrays(c, 1, &objects[0]);
    EXPECT_EQ(asked(GL_VERTEX_ARRAY_BINDING), 0);
    EXPECT_TRUE(gl().IsEnabled(c, GL_VERTEX_ARRAY)) << "what is set under no name";
    EXPECT_FALSE(gl().IsVertexArray(c, objects[0]));
}

TEST_F(VertexArrayObjectsTest, ADeletedBufferStaysInThoseThatAreNotBound) {
    for (const int i : {0, 1}) {
        gl().BindVertexArray(c, objects[i]);
        positions_in(buffers[0]);
        gl().BindBuffer(c, GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    }
    const std::weak_ptr<Buffer> vertices = share->buffers.find(buffers[0]), indices = share->buffers.find(buffers[1]);
    gl().DeleteBuffers(c, 2, buffers);
    EXPECT_EQ(asked(GL_VERTEX_ARRAY_BUFFER_BINDING), 0);
    EXPECT_EQ(asked(GL_ELEMENT_ARRAY_BUFFER_BINDING), 0);
    EXPECT_EQ(asked(GL_ARRAY_BUFFER_BINDING), 0);
    EXPECT_EQ(input(), nullptr) << "it left the bound one";
    gl().BindVertexArray(c, objects[0]);
    VertexInput* const kept = input(true);
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->buffers().front(), vertices.lock());
    gl().DeleteVertexArrays(c, 1, &objects[0]);
    EXPECT_TRUE(vertices.expired());
    EXPECT_TRUE(indices.expired());
}

TEST_F(VertexArrayObjectsTest, AnotherContextsDeletionTakesNothingAway) {
    gl().BindVertexArray(c, objects[0]);
    positions_in(buffers[0]);
    gl().BindVertexArray(c, 0);
    const std::weak_ptr<Buffer> vertices = share->buffers.find(buffers[0]);
    Context other{share};
    other.table->DeleteBuffers(other, 1, &buffers[0]);
    EXPECT_FALSE(other.table->IsVertexArray(other, objects[0])) << "no context shares them";
    let_go_of_deleted_buffers(c);
    gl().BindVertexArray(c, objects[0]);
    EXPECT_TRUE(input());
    EXPECT_FALSE(vertices.expired());
}

TEST_F(VertexArrayObjectsTest, PopBringsTheObjectAndItsContentBack) {
    gl().BindVertexArray(c, objects[0]);
    positions_in(buffers[0]);
    gl().PushClientAttrib(c, GL_CLIENT_VERTEX_ARRAY_BIT);
    gl().DisableClientState(c, GL_VERTEX_ARRAY);
    gl().BindVertexArray(c, objects[1]);
    gl().EnableClientState(c, GL_NORMAL_ARRAY);
    gl().PopClientAttrib(c);
    EXPECT_EQ(asked(GL_VERTEX_ARRAY_BINDING), name(objects[0]));
    EXPECT_TRUE(gl().IsEnabled(c, GL_VERTEX_ARRAY));
    EXPECT_FALSE(gl().IsEnabled(c, GL_NORMAL_ARRAY));
    gl().BindVertexArray(c, objects[1]);
    EXPECT_TRUE(gl().IsEnabled(c, GL_NORMAL_ARRAY)) << "the other one was left as it was";
}

TEST_F(VertexArrayObjectsTest, PopDoesNotBringADeletedOneBack) {
    gl().BindVertexArray(c, objects[0]);
    gl().PushClientAttrib(c, GL_CLIENT_ALL_ATTRIB_BITS);
    gl().PixelStorei(c, GL_PACK_ALIGNMENT, 8);
    gl().DeleteVertexArrays(c, 1, &objects[0]);
    gl().EnableClientState(c, GL_NORMAL_ARRAY);
    gl().PopClientAttrib(c);
    EXPECT_EQ(asked(GL_VERTEX_ARRAY_BINDING), 0);
    EXPECT_TRUE(gl().IsEnabled(c, GL_NORMAL_ARRAY));
    EXPECT_EQ(asked(GL_PACK_ALIGNMENT), 4) << "of another group";
    EXPECT_FALSE(gl().IsVertexArray(c, objects[0]));
}

}  // namespace
}  // namespace wall::client
