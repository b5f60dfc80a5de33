// SPDX-License-Identifier: MIT
// Mapping, storage and copies of buffer objects: the errors of the specification, and what the program sees.
#include "client_lib/objects/buffer.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

constexpr GLenum kTarget = GL_ARRAY_BUFFER;
constexpr GLsizeiptr kSize = 10000;

class BuffersTest : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        gl().GenBuffers(c, 2, names);
        gl().BindBuffer(c, GL_COPY_WRITE_BUFFER, names[1]);
        gl().BufferData(c, GL_COPY_WRITE_BUFFER, kSize, nullptr, GL_STATIC_DRAW);
        gl().BindBuffer(c, kTarget, names[0]);
        gl().BufferData(c, kTarget, kSize, nullptr, GL_STATIC_DRAW);
    }
    GLbyte* map(GLintptr offset, GLsizeiptr length, GLbitfield access) {
        return static_cast<GLbyte*>(gl().MapBufferRange(c, kTarget, offset, length, access));
    }
    GLenum error_of_map(GLintptr offset, GLsizeiptr length, GLbitfield access) {
        EXPECT_EQ(map(offset, length, access), nullptr);
        return error();
    }
    GLenum error_of_storage(GLsizeiptr size, GLbitfield flags) {
        gl().BufferStorage(c, kTarget, size, nullptr, flags);
        return error();
    }
    GLint asked(GLenum word, GLenum target = kTarget) {
        GLint value = -1;
        gl().GetBufferParameteriv(c, target, word, &value);
        return value;
    }
    GLbyte byte(GLintptr at, GLenum target = kTarget) {
        GLbyte value = -1;
        gl().GetBufferSubData(c, target, at, 1, &value);
        return value;
    }
    GLuint names[2] = {};
};

TEST_F(BuffersTest, ARangeIsMapped) {
    GLbyte* const mapped = map(100, 50, GL_MAP_WRITE_BIT);
    ASSERT_TRUE(mapped);
    mapped[0] = 1, mapped[49] = 2;
    EXPECT_EQ(asked(GL_BUFFER_MAPPED), GL_TRUE);
    EXPECT_EQ(asked(GL_BUFFER_MAP_OFFSET), 100);
    EXPECT_EQ(asked(GL_BUFFER_MAP_LENGTH), 50);
    EXPECT_EQ(asked(GL_BUFFER_ACCESS_FLAGS), GL_MAP_WRITE_BIT);
    EXPECT_EQ(asked(GL_BUFFER_ACCESS), GL_WRITE_ONLY);
    void* pointer = nullptr;
    gl().GetBufferPointerv(c, kTarget, GL_BUFFER_MAP_POINTER, &pointer);
    EXPECT_EQ(pointer, mapped);
    EXPECT_TRUE(gl().UnmapBuffer(c, kTarget));
    EXPECT_EQ(asked(GL_BUFFER_MAPPED), GL_FALSE);
    EXPECT_EQ(asked(GL_BUFFER_MAP_LENGTH), 0);
    EXPECT_EQ(byte(100), 1);
    EXPECT_EQ(byte(149), 2);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(BuffersTest, ErrorsOfMapping) {
    constexpr GLbitfield kWrite = GL_MAP_WRITE_BIT, kRead = GL_MAP_READ_BIT;
    EXPECT_EQ(error_of_map(-1, 10, kWrite), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_map(0, -1, kWrite), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_map(kSize - 5, 6, kWrite), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_map(kSize + 1, 1, kWrite), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_map(0, 10, kWrite | 0x8000), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_map(0, 0, kWrite), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(error_of_map(0, 10, 0), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(error_of_map(0, 10, GL_MAP_UNSYNCHRONIZED_BIT), GLenum{GL_INVALID_OPERATION});
    for (const GLbitfield flag : {GL_MAP_INVALIDATE_RANGE_BIT, GL_MAP_INVALIDATE_BUFFER_BIT, GL_MAP_UNSYNCHRONIZED_BIT})
        EXPECT_EQ(error_of_map(0, 10, kRead | flag), GLenum{GL_INVALID_OPERATION}) << flag;
    EXPECT_EQ(error_of_map(0, 10, kRead | GL_MAP_FLUSH_EXPLICIT_BIT), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(error_of_map(0, 10, kWrite | GL_MAP_PERSISTENT_BIT), GLenum{GL_INVALID_OPERATION}) << "not such storage";
    ASSERT_TRUE(map(0, 10, kWrite));
    EXPECT_EQ(error_of_map(20, 10, kWrite), GLenum{GL_INVALID_OPERATION}) << "it is mapped";
    gl().BufferSubData(c, kTarget, 0, 1, names);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    byte(50);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BufferData(c, kTarget, 100, nullptr, GL_STATIC_DRAW);  // ends the mapping
    EXPECT_EQ(asked(GL_BUFFER_MAPPED), GL_FALSE);
    gl().UnmapBuffer(c, kTarget);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindBuffer(c, kTarget, 0);
    EXPECT_EQ(error_of_map(0, 10, kWrite), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(gl().MapBufferRange(c, GL_TEXTURE_2D, 0, 1, kWrite), nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(BuffersTest, ErrorsOfFlushing) {
    const auto flush = [&](GLintptr offset, GLsizeiptr length) {
        gl().FlushMappedBufferRange(c, kTarget, offset, length);
        return error();
    };
    EXPECT_EQ(flush(0, 1), GLenum{GL_INVALID_OPERATION}) << "it is not mapped";
    map(100, 50, GL_MAP_WRITE_BIT);
    EXPECT_EQ(flush(0, 1), GLenum{GL_INVALID_OPERATION}) << "not in that way";
    gl().UnmapBuffer(c, kTarget);
    map(100, 50, GL_MAP_WRITE_BIT | GL_MAP_FLUSH_EXPLICIT_BIT);
    EXPECT_EQ(flush(0, 50), GLenum{GL_NO_ERROR});
    EXPECT_EQ(flush(50, 0), GLenum{GL_NO_ERROR});
    EXPECT_EQ(flush(10, 41), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(flush(-1, 2), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(flush(0, -2), GLenum{GL_INVALID_VALUE});
}

TEST_F(BuffersTest, StorageIsForGood) {
    EXPECT_EQ(error_of_storage(0, 0), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_storage(100, 0x8000), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_storage(100, GL_MAP_PERSISTENT_BIT), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_storage(100, GL_MAP_WRITE_BIT | GL_MAP_COHERENT_BIT), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(asked(GL_BUFFER_IMMUTABLE_STORAGE), GL_FALSE);
    EXPECT_EQ(error_of_storage(100, GL_MAP_READ_BIT), GLenum{GL_NO_ERROR});
    EXPECT_EQ(asked(GL_BUFFER_IMMUTABLE_STORAGE), GL_TRUE);
    EXPECT_EQ(asked(GL_BUFFER_STORAGE_FLAGS), GL_MAP_READ_BIT);
    EXPECT_EQ(asked(GL_BUFFER_SIZE), 100);
    EXPECT_EQ(error_of_storage(100, 0), GLenum{GL_INVALID_OPERATION});
    gl().BufferData(c, kTarget, 100, nullptr, GL_STATIC_DRAW);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BufferSubData(c, kTarget, 0, 1, names);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "not dynamic";
    EXPECT_EQ(error_of_map(0, 10, GL_MAP_WRITE_BIT), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(gl().MapBuffer(c, kTarget, GL_READ_WRITE), nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_TRUE(map(0, 10, GL_MAP_READ_BIT));
}

TEST_F(BuffersTest, APersistentMappingLetsTheBufferBeUsed) {
    constexpr GLbitfield kFlags = GL_MAP_WRITE_BIT | GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    ASSERT_EQ(error_of_storage(kSize, kFlags | GL_DYNAMIC_STORAGE_BIT), GLenum{GL_NO_ERROR});
    GLbyte* const mapped = map(0, kSize, kFlags);
    ASSERT_TRUE(mapped);
    mapped[7] = 3;
    EXPECT_EQ(byte(7), 3);
    const GLbyte nine = 9;
    gl().BufferSubData(c, kTarget, 8, 1, &nine);
    EXPECT_EQ(mapped[8], 9);
    gl().CopyBufferSubData(c, kTarget, GL_COPY_WRITE_BUFFER, 0, 100, 20);
    EXPECT_EQ(byte(107, GL_COPY_WRITE_BUFFER), 3);
    gl().BindBuffer(c, GL_PIXEL_UNPACK_BUFFER, names[0]);
    gl().PixelMapusv(c, GL_PIXEL_MAP_R_TO_R, 2, nullptr);
    gl().MemoryBarrier(c, GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().MemoryBarrier(c, 0x80000000u);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().UnmapBuffer(c, kTarget);
    EXPECT_EQ(byte(8), 9);
}

TEST_F(BuffersTest, Copies) {
    const GLbyte values[] = {1, 2, 3, 4, 5};
    gl().BufferSubData(c, kTarget, 0, sizeof values, values);
    gl().CopyBufferSubData(c, kTarget, GL_COPY_WRITE_BUFFER, 1, kSize - 4, 4);
    EXPECT_EQ(byte(kSize - 1, GL_COPY_WRITE_BUFFER), 5);
    gl().CopyBufferSubData(c, kTarget, kTarget, 0, 5, 5);
    EXPECT_EQ(byte(9), 5);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    const auto error_of_copy = [&](GLenum from, GLenum to, GLintptr at, GLintptr to_at, GLsizeiptr size) {
        gl().CopyBufferSubData(c, from, to, at, to_at, size);
        return error();
    };
    EXPECT_EQ(error_of_copy(kTarget, kTarget, 0, 4, 5), GLenum{GL_INVALID_VALUE}) << "overlap";
    EXPECT_EQ(error_of_copy(kTarget, GL_COPY_WRITE_BUFFER, 0, kSize - 4, 5), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_copy(kTarget, GL_COPY_WRITE_BUFFER, kSize - 4, 0, 5), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_copy(kTarget, GL_COPY_WRITE_BUFFER, -1, 0, 5), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_copy(kTarget, GL_COPY_WRITE_BUFFER, 0, 0, -5), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(error_of_copy(kTarget, GL_COPY_READ_BUFFER, 0, 0, 5), GLenum{GL_INVALID_OPERATION}) << "none is bound";
    EXPECT_EQ(error_of_copy(GL_TEXTURE_2D, kTarget, 0, 0, 5), GLenum{GL_INVALID_ENUM});
    map(0, 1, GL_MAP_READ_BIT);
    EXPECT_EQ(error_of_copy(kTarget, GL_COPY_WRITE_BUFFER, 0, 0, 5), GLenum{GL_INVALID_OPERATION}) << "mapped";
}

TEST_F(BuffersTest, ADeletedBufferLeavesItsTargets) {
    gl().DeleteBuffers(c, 1, &names[1]);
    GLint bound = -1;
    gl().GetIntegerv(c, GL_COPY_WRITE_BUFFER_BINDING, &bound);
    EXPECT_EQ(bound, 0);
}

TEST_F(BuffersTest, DrawsWhoseArgumentsAreNotAllThereAreRefused) {
    GLuint name = 0;
    gl().GenBuffers(c, 1, &name);
    gl().BindBuffer(c, GL_DRAW_INDIRECT_BUFFER, name);
    gl().BufferData(c, GL_DRAW_INDIRECT_BUFFER, 20, nullptr, GL_STATIC_DRAW);
    for (const GLsizei draws : {2, 0x7fffffff}) {
        gl().MultiDrawArraysIndirect(c, GL_TRIANGLES, nullptr, draws, 0);
        EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << draws;
    }
    gl().MultiDrawArraysIndirect(c, GL_TRIANGLES, nullptr, 0, 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

}  // namespace
}  // namespace wall::client
