// SPDX-License-Identifier: MIT
// Buffer objects that several contexts use (OpenGL 2.1, appendix D): what one deletes the others keep, and what one
// thread reads no other takes away.
#include <atomic>
#include <thread>

#include "client_lib/context/buffer_binding.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

constexpr GLfloat kPlaces[] = {1, 2, 3, 4, 5, 6};

class SharedBufferTest : public ContextTest {
protected:
    /// Binds the buffer as the array of vertices of a context.
    static void use(Context& context, GLuint name) {
        context.table->BindBuffer(context, GL_ARRAY_BUFFER, name);
        context.table->VertexPointer(context, 2, GL_FLOAT, 0, nullptr);
        context.table->EnableClientState(context, GL_VERTEX_ARRAY);
    }
    /// What the context would draw of its first vertex.
    static float first_drawn(Context& context) {
        context.table->DrawArrays(context, GL_POINTS, 0, 1);
        float x = 0;
        std::memcpy(&x, context.packer.operand_at(4), sizeof x);  // behind glBegin's mode
        context.packer.reset();
        return x;
    }
    void SetUp() override {
        ContextTest::SetUp();
        gl().GenBuffers(c, 1, &name);
        gl().BindBuffer(c, GL_ARRAY_BUFFER, name);
        gl().BufferData(c, GL_ARRAY_BUFFER, sizeof kPlaces, kPlaces, GL_STATIC_DRAW);
    }
    GLint binding(Context& context) {
        GLint bound = -1;
        context.table->GetIntegerv(context, GL_ARRAY_BUFFER_BINDING, &bound);
        return bound;
    }

    Context other{share};
    GLuint name = 0;
};

TEST_F(SharedBufferTest, WhatOneContextDeletesAnotherKeeps) {
    use(c, name);
    use(other, name);
    gl().DeleteBuffers(c, 1, &name);
    EXPECT_EQ(binding(c), 0);
    EXPECT_EQ(binding(other), static_cast<GLint>(name));
    EXPECT_FALSE(other.table->IsBuffer(other, name));
    EXPECT_EQ(first_drawn(other), 1);
    EXPECT_EQ(first_drawn(c), 0);

    const GLfloat seven = 7;  // it is still an object, by its binding
    other.table->BufferSubData(other, GL_ARRAY_BUFFER, 0, sizeof seven, &seven);
    EXPECT_EQ(first_drawn(other), 7);
    EXPECT_EQ(other.take_error(), GLenum{GL_NO_ERROR});
}

TEST_F(SharedBufferTest, TheNameMeansAnotherObjectAfterwards) {
    use(other, name);
    gl().DeleteBuffers(c, 1, &name);
    gl().BindBuffer(c, GL_ARRAY_BUFFER, name);
    gl().BufferData(c, GL_ARRAY_BUFFER, 4, nullptr, GL_STATIC_DRAW);
    EXPECT_EQ(first_drawn(other), 1);
    use(other, name);
    EXPECT_EQ(first_drawn(other), 0);
}

TEST_F(SharedBufferTest, ADeletedBufferGoesWithItsLastUse) {
    use(other, name);
    const std::weak_ptr<Buffer> watched = share->buffers.find(name);
    gl().DeleteBuffers(c, 1, &name);
    first_drawn(other);
    other.table->BindBuffer(other, GL_ARRAY_BUFFER, 0);
    EXPECT_FALSE(watched.expired());  // the array is in it
    other.table->PushClientAttrib(other, GL_CLIENT_ALL_ATTRIB_BITS);
    other.table->VertexPointer(other, 2, GL_FLOAT, 0, kPlaces);
    other.table->BindBuffer(other, GL_ARRAY_BUFFER, 0);
    EXPECT_FALSE(watched.expired());  // saved
    other.table->PopClientAttrib(other);
    EXPECT_EQ(first_drawn(other), 1);
    other.table->VertexPointer(other, 2, GL_FLOAT, 0, kPlaces);
    other.table->BindBuffer(other, GL_ARRAY_BUFFER, 0);
    EXPECT_TRUE(watched.expired());
}

TEST_F(SharedBufferTest, WhatIsReadStaysAsItIs) {
    const BufferReading reading = buffer_content(c, ClientName(c.state.local.array_buffer), 0);
    const GLfloat nines[] = {9, 9, 9, 9, 9, 9};
    gl().BufferSubData(c, GL_ARRAY_BUFFER, 0, sizeof nines, nines);
    EXPECT_EQ(std::memcmp(reading.bytes().data(), kPlaces, sizeof kPlaces), 0);
    gl().BufferData(c, GL_ARRAY_BUFFER, 4, nullptr, GL_STATIC_DRAW);
    EXPECT_EQ(std::memcmp(reading.bytes().data(), kPlaces, sizeof kPlaces), 0);
    EXPECT_EQ(buffer_content(c, ClientName(c.state.local.array_buffer), 0).bytes().size(), 4u);
}

TEST_F(SharedBufferTest, PixelCommandsHoldTheirMemoryUntilTheNextOne) {
    gl().BindBuffer(c, GL_PIXEL_UNPACK_BUFFER, name);
    const auto* source = static_cast<const GLfloat*>(unpack_source(c, nullptr, sizeof kPlaces));
    Context& writer = other;
    writer.table->BindBuffer(writer, GL_ARRAY_BUFFER, name);
    writer.table->BufferData(writer, GL_ARRAY_BUFFER, 4, nullptr, GL_STATIC_DRAW);
    EXPECT_EQ(source[5], 6);
}

TEST_F(SharedBufferTest, OneThreadDrawsWhileAnotherReplacesTheContent) {
    use(other, name);
    std::atomic<bool> stop{false};
    std::thread drawing([&] {
        while (!stop) {
            other.table->DrawArrays(other, GL_POINTS, 0, 3);
            other.packer.reset();
        }
    });
    const std::vector<GLfloat> much(20000, 1.0f);
    for (int i = 0; i < 500; ++i) {
        gl().BufferData(c, GL_ARRAY_BUFFER, i % 2 ? sizeof kPlaces : static_cast<GLsizeiptr>(much.size() * 4),
                        much.data(), GL_STREAM_DRAW);
        gl().BufferSubData(c, GL_ARRAY_BUFFER, 0, sizeof kPlaces, kPlaces);
        if (i == 400) gl().DeleteBuffers(c, 1, &name), gl().BindBuffer(c, GL_ARRAY_BUFFER, name);
    }
    stop = true;
    drawing.join();
}

}  // namespace
}  // namespace wall::client
