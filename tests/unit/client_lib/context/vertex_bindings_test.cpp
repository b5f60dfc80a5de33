// SPDX-License-Identifier: MIT
// Vertex attributes and the places for buffers that they are bound to: which arrays follow, and what is answered.
#include "client_lib/context/vertex_bindings.h"

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/vertex_array_objects.h"
#include "common/glstate/vertex_input.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class VertexBindingsTest : public ContextTest {
protected:
    const glstate::ClientArray& array(unsigned i) { return c.state.vertex_arrays.attrib_array[i]; }
    GLint of_attribute(GLuint i, GLenum word) {
        GLint value = -1;
        gl().GetVertexAttribiv(c, i, word, &value);
        return value;
    }
    GLint of_place(GLuint i, GLenum word) {
        GLint value = -1;
        gl().GetIntegeri_v(c, word, i, &value);
        return value;
    }
    GLuint buffer() {
        GLuint name = 0;
        gl().CreateBuffers(c, 1, &name);
        return name;
    }
};

TEST_F(VertexBindingsTest, ElementsMayLieSoFarApart) {
    EXPECT_GT(longest_stride_of_pointers(false, 4, 3), kLongestStride);
    EXPECT_EQ(longest_stride_of_pointers(false, 4, 4), kLongestStride);
    EXPECT_GT(longest_stride_of_pointers(true, 3, 0), kLongestStride);
    EXPECT_EQ(longest_stride_of_pointers(true, 3, 1), kLongestStride);
    gl().VertexAttribPointer(c, 2, 4, GL_FLOAT, GL_FALSE, -1, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().VertexAttribPointer(c, 2, 4, GL_FLOAT, GL_FALSE, kLongestStride + 1, nullptr);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR}) << "an older version";
}

TEST_F(VertexBindingsTest, AnArrayIsAPlaceOfItsOwn) {
    const GLuint name = buffer();
    gl().BindBuffer(c, GL_ARRAY_BUFFER, name);
    gl().VertexAttribPointer(c, 2, 3, GL_FLOAT, GL_FALSE, 0, reinterpret_cast<const void*>(48));
    gl().VertexAttribDivisor(c, 2, 7);
    EXPECT_FALSE(c.vertex_array_objects->bindings) << "nothing has told the two apart";
    EXPECT_EQ(of_attribute(2, GL_VERTEX_ATTRIB_BINDING), 2);
    EXPECT_EQ(of_attribute(2, GL_VERTEX_ATTRIB_RELATIVE_OFFSET), 0);
    EXPECT_EQ(of_place(2, GL_VERTEX_BINDING_OFFSET), 48);
    EXPECT_EQ(of_place(2, GL_VERTEX_BINDING_STRIDE), 12);
    EXPECT_EQ(of_place(2, GL_VERTEX_BINDING_DIVISOR), 7);
    EXPECT_EQ(of_place(2, GL_VERTEX_BINDING_BUFFER), static_cast<GLint>(name));
    EXPECT_EQ(of_place(0, GL_VERTEX_BINDING_STRIDE), 16);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(VertexBindingsTest, AttributesOfOnePlaceFollowIt) {
    gl().VertexAttribFormat(c, 0, 3, GL_FLOAT, GL_FALSE, 0);
    gl().VertexAttribFormat(c, 1, 4, GL_UNSIGNED_BYTE, GL_TRUE, 12);
    gl().VertexAttribBinding(c, 0, 9);
    gl().VertexAttribBinding(c, 1, 9);
    const GLuint first = buffer(), second = buffer();
    gl().BindVertexBuffer(c, 9, first, 160, 16);
    EXPECT_EQ(array(0).pointer, 160u);
    EXPECT_EQ(array(1).pointer, 172u);
    EXPECT_EQ(array(1).stride, 16);
    EXPECT_EQ(array(1).buffer, array(0).buffer);
    gl().BindVertexBuffer(c, 9, second, 0, 32);
    gl().VertexBindingDivisor(c, 9, 2);
    EXPECT_EQ(array(1).pointer, 12u);
    EXPECT_EQ(array(0).stride, 32);
    EXPECT_EQ(array(0).divisor, 2u);
    EXPECT_EQ(of_place(9, GL_VERTEX_BINDING_BUFFER), static_cast<GLint>(second));
    EXPECT_EQ(of_attribute(1, GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING), static_cast<GLint>(second));
    EXPECT_EQ(of_attribute(1, GL_VERTEX_ATTRIB_ARRAY_STRIDE), 0) << "what glVertexAttribPointer said";
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(VertexBindingsTest, APointerTakesTheAttributeBack) {
    gl().VertexAttribBinding(c, 0, 1);
    gl().VertexAttribBinding(c, 3, 1);
    gl().BindVertexBuffer(c, 1, buffer(), 8, 24);
    gl().BindBuffer(c, GL_ARRAY_BUFFER, buffer());
    gl().VertexAttribPointer(c, 1, 2, GL_SHORT, GL_FALSE, 0, reinterpret_cast<const void*>(4));
    EXPECT_EQ(of_attribute(1, GL_VERTEX_ATTRIB_BINDING), 1);
    EXPECT_EQ(array(1).pointer, 4u);
    EXPECT_EQ(array(3).pointer, 4u) << "its place has changed";
    EXPECT_EQ(array(3).stride, 4);
    gl().VertexAttribPointer(c, 0, 2, GL_SHORT, GL_FALSE, 0, reinterpret_cast<const void*>(100));
    EXPECT_EQ(of_attribute(0, GL_VERTEX_ATTRIB_BINDING), 0);
    EXPECT_EQ(array(3).pointer, 4u);
}

TEST_F(VertexBindingsTest, WithoutAStrideThereIsOneElement) {
    gl().BindVertexBuffer(c, 0, buffer(), 0, 0);
    EXPECT_EQ(array(0).divisor, glstate::kNeverSteps);
    EXPECT_EQ(of_attribute(0, GL_VERTEX_ATTRIB_ARRAY_DIVISOR), 0);
    EXPECT_EQ(of_place(0, GL_VERTEX_BINDING_STRIDE), 0);
}

TEST_F(VertexBindingsTest, WhereThereIsNoBufferNothingIsRead) {
    gl().VertexAttribFormat(c, 0, 4, GL_FLOAT, GL_FALSE, 16);
    EXPECT_EQ(array(0).pointer, 0u);
    gl().BindVertexBuffer(c, 0, 0, 64, 16);
    EXPECT_EQ(array(0).pointer, 0u);
}

TEST_F(VertexBindingsTest, BelongToTheVertexArrayObject) {
    gl().VertexAttribBinding(c, 4, 8);
    GLuint name = 0;
    gl().CreateVertexArrays(c, 1, &name);
    gl().BindVertexArray(c, name);
    EXPECT_EQ(of_attribute(4, GL_VERTEX_ATTRIB_BINDING), 4);
    gl().VertexAttribBinding(c, 4, 6);
    gl().BindVertexArray(c, 0);
    EXPECT_EQ(of_attribute(4, GL_VERTEX_ATTRIB_BINDING), 8);
    gl().PushClientAttrib(c, GL_CLIENT_VERTEX_ARRAY_BIT);
    gl().VertexAttribBinding(c, 4, 2);
    gl().PopClientAttrib(c);
    EXPECT_EQ(of_attribute(4, GL_VERTEX_ATTRIB_BINDING), 8);
    gl().BindVertexArray(c, name);
    EXPECT_EQ(of_attribute(4, GL_VERTEX_ATTRIB_BINDING), 6);
}

TEST_F(VertexBindingsTest, AnObjectKeepsABufferThatIsDeleted) {
    GLuint array_name = 0;
    GLuint name = buffer();
    gl().CreateVertexArrays(c, 1, &array_name);
    gl().VertexArrayVertexBuffer(c, array_name, 11, name, 0, 16);
    gl().DeleteBuffers(c, 1, &name);
    EXPECT_TRUE(c.buffers->holds_deleted);
    gl().DeleteVertexArrays(c, 1, &array_name);
    EXPECT_FALSE(c.buffers->holds_deleted);
}

TEST_F(VertexBindingsTest, Errors) {
    const auto is = [&](GLenum wanted) { EXPECT_EQ(error(), wanted); };
    gl().VertexAttribFormat(c, 16, 4, GL_FLOAT, GL_FALSE, 0), is(GL_INVALID_VALUE);
    gl().VertexAttribFormat(c, 0, 5, GL_FLOAT, GL_FALSE, 0), is(GL_INVALID_VALUE);
    gl().VertexAttribFormat(c, 0, 4, GL_RGBA, GL_FALSE, 0), is(GL_INVALID_ENUM);
    gl().VertexAttribFormat(c, 0, 4, GL_FLOAT, GL_FALSE, 2048), is(GL_INVALID_VALUE);
    gl().VertexAttribFormat(c, 0, 4, GL_UNSIGNED_INT_10F_11F_11F_REV, GL_FALSE, 0), is(GL_INVALID_OPERATION);
    gl().VertexAttribFormat(c, 0, 3, GL_UNSIGNED_INT_10F_11F_11F_REV, GL_FALSE, 0), is(GL_NO_ERROR);
    gl().VertexAttribIFormat(c, 0, 4, GL_FLOAT, 0), is(GL_INVALID_ENUM);
    gl().VertexAttribLFormat(c, 0, 4, GL_FLOAT, 0), is(GL_INVALID_ENUM);
    gl().VertexAttribLFormat(c, 0, 4, GL_DOUBLE, 0), is(GL_NO_ERROR);
    EXPECT_EQ(of_attribute(0, GL_VERTEX_ATTRIB_ARRAY_LONG), 1);
    gl().VertexAttribBinding(c, 0, 16), is(GL_INVALID_VALUE);
    gl().VertexBindingDivisor(c, 16, 1), is(GL_INVALID_VALUE);
    gl().BindVertexBuffer(c, 0, 0, -1, 0), is(GL_INVALID_VALUE);
    gl().BindVertexBuffer(c, 0, 0, 0, 2049), is(GL_INVALID_VALUE);
    gl().BindVertexBuffer(c, 0, 99, 0, 16), is(GL_INVALID_OPERATION);
    gl().BindVertexBuffers(c, 15, 2, nullptr, nullptr, nullptr), is(GL_INVALID_OPERATION);
}

TEST_F(VertexBindingsTest, DoublesAreAnsweredAsTheyWere) {
    gl().VertexAttribL4d(c, 3, 0.1, 1e300, -2, 1);
    GLdouble got[4] = {};
    gl().GetVertexAttribLdv(c, 3, GL_CURRENT_VERTEX_ATTRIB, got);
    EXPECT_EQ(got[0], 0.1);
    EXPECT_EQ(got[1], 1e300);
    GLfloat floats[4] = {};
    gl().GetVertexAttribfv(c, 3, GL_CURRENT_VERTEX_ATTRIB, floats);
    EXPECT_EQ(floats[2], -2.0f);
    gl().VertexAttribLPointer(c, 1, 3, GL_DOUBLE, 0, nullptr);
    EXPECT_EQ(of_attribute(1, GL_VERTEX_ATTRIB_ARRAY_LONG), 1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().VertexAttribLPointer(c, 1, 3, GL_FLOAT, 0, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

}  // namespace
}  // namespace wall::client
