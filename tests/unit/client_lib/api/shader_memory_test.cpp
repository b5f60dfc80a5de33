// SPDX-License-Identifier: MIT
// Images, blocks of storage, atomic counters and compute shaders: bindings, what can be asked of them, errors.
#include "client_lib/context/shader_memory.h"
#include "client_lib/objects/program.h"
#include "client_lib/objects/texture.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

namespace el = glstate::el;

glapi::ProgramReflection reflection() {
    glapi::ProgramReflection r;
    r.linked = true;
    r.uniforms = {{GL_IMAGE_2D, 2, false, true, "pictures", {0, 3}},
                  {GL_UNSIGNED_INT_ATOMIC_COUNTER, 2, false, true, "hits", {}, {-1, 8, 4, 0, false}, 0}};
    r.storage_blocks = {{{"Read", 16, 1, 1}, false}, {{"Written[0]", 32, 2, 2}, true}};
    r.counter_buffers = {{4, 16, 1u << 5}};
    r.group_size = {8, 4, 1};
    return r;
}

class ShaderMemoryTest : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        name_ = gl().CreateProgram(c);
        program_ = std::static_pointer_cast<Program>(share->glsl_objects.find(name_));
        program_->executable = Executable::make({}, reflection());
        ASSERT_TRUE(program_->executable);
        program_->linked = true;
        gl().UseProgram(c, name_);
    }
    GLuint texture(GLenum format = GL_RGBA8) {
        GLuint made = 0;
        gl().GenTextures(c, 1, &made);
        gl().BindTexture(c, GL_TEXTURE_2D, made);
        gl().TexStorage2D(c, GL_TEXTURE_2D, 1, format, 8, 8);
        return made;
    }
    GLuint buffer(GLenum target) {
        GLuint made = 0;
        gl().GenBuffers(c, 1, &made);
        gl().BindBuffer(c, target, made);
        gl().BufferData(c, target, 64, nullptr, GL_DYNAMIC_DRAW);
        return made;
    }
    GLint of_unit(GLuint unit, GLenum word) {
        GLint value = -99;
        gl().GetIntegeri_v(c, word, unit, &value);
        return value;
    }
    std::size_t written() {
        std::size_t count = 0;
        std::lock_guard lock(share->mutex);
        for_each_written(c, [&](const Object&) { ++count; });
        return count;
    }

    GLuint name_ = 0;
    std::shared_ptr<Program> program_;
};

TEST_F(ShaderMemoryTest, ImagesAreBoundToUnits) {
    const GLuint made = texture();
    gl().BindImageTexture(c, 3, made, 0, GL_TRUE, 2, GL_READ_WRITE, GL_R32F);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(of_unit(3, GL_IMAGE_BINDING_NAME), static_cast<GLint>(made));
    EXPECT_EQ(of_unit(3, GL_IMAGE_BINDING_LAYERED), 0) << "it has no layers";
    EXPECT_EQ(of_unit(3, GL_IMAGE_BINDING_LAYER), 0);
    EXPECT_EQ(of_unit(3, GL_IMAGE_BINDING_ACCESS), GL_READ_WRITE);
    EXPECT_EQ(of_unit(3, GL_IMAGE_BINDING_FORMAT), GL_R32F);
    gl().DeleteTextures(c, 1, &made);
    EXPECT_EQ(of_unit(3, GL_IMAGE_BINDING_NAME), 0);
    of_unit(el::image_unit::count, GL_IMAGE_BINDING_NAME);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(ShaderMemoryTest, ErrorsOfBindingImages) {
    const GLuint made = texture();
    const auto bind = [&](GLuint unit, GLuint name, GLint level, GLint layer, GLenum access, GLenum format) {
        gl().BindImageTexture(c, unit, name, level, GL_FALSE, layer, access, format);
        return error();
    };
    EXPECT_EQ(bind(el::image_unit::count, made, 0, 0, GL_READ_ONLY, GL_R8), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(bind(0, made + 1, 0, 0, GL_READ_ONLY, GL_R8), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(bind(0, made, -1, 0, GL_READ_ONLY, GL_R8), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(bind(0, made, 0, -1, GL_READ_ONLY, GL_R8), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(bind(0, made, 0, 0, GL_FLOAT, GL_R8), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(bind(0, made, 0, 0, GL_READ_ONLY, GL_RGB8), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(of_unit(0, GL_IMAGE_BINDING_NAME), 0);
}

TEST_F(ShaderMemoryTest, SeveralImagesAtOnce) {
    const GLuint good = texture(), other = texture(GL_RGB8);
    const GLuint names[] = {good, other, 0};
    gl().BindImageTextures(c, 4, 3, names);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "that format is none for images";
    EXPECT_EQ(of_unit(4, GL_IMAGE_BINDING_NAME), static_cast<GLint>(good));
    EXPECT_EQ(of_unit(4, GL_IMAGE_BINDING_FORMAT), GL_RGBA8);
    EXPECT_EQ(of_unit(4, GL_IMAGE_BINDING_ACCESS), GL_READ_WRITE);
    EXPECT_EQ(of_unit(5, GL_IMAGE_BINDING_NAME), 0);
    gl().BindImageTextures(c, el::image_unit::count - 1, 2, nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindImageTextures(c, 4, 1, nullptr);
    EXPECT_EQ(of_unit(4, GL_IMAGE_BINDING_NAME), 0);
}

TEST_F(ShaderMemoryTest, AnImageUniformNamesAUnit) {
    gl().Uniform1i(c, 0, 5);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().Uniform1i(c, 0, el::image_unit::count);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().Uniform1f(c, 0, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(gl().GetUniformLocation(c, name_, "hits"), -1);
}

TEST_F(ShaderMemoryTest, CountersLieInBuffers) {
    const auto of_buffer = [&](GLuint index, GLenum word) {
        GLint value = -99;
        gl().GetActiveAtomicCounterBufferiv(c, name_, index, word, &value);
        return value;
    };
    EXPECT_EQ(of_buffer(0, GL_ATOMIC_COUNTER_BUFFER_BINDING), 4);
    EXPECT_EQ(of_buffer(0, GL_ATOMIC_COUNTER_BUFFER_DATA_SIZE), 16);
    EXPECT_EQ(of_buffer(0, GL_ATOMIC_COUNTER_BUFFER_ACTIVE_ATOMIC_COUNTERS), 1);
    EXPECT_EQ(of_buffer(0, GL_ATOMIC_COUNTER_BUFFER_ACTIVE_ATOMIC_COUNTER_INDICES), 1);
    EXPECT_EQ(of_buffer(0, GL_ATOMIC_COUNTER_BUFFER_REFERENCED_BY_COMPUTE_SHADER), GL_TRUE);
    EXPECT_EQ(of_buffer(0, GL_ATOMIC_COUNTER_BUFFER_REFERENCED_BY_VERTEX_SHADER), GL_FALSE);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    of_buffer(1, GL_ATOMIC_COUNTER_BUFFER_BINDING);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    GLint value = 0;
    gl().GetProgramiv(c, name_, GL_ACTIVE_ATOMIC_COUNTER_BUFFERS, &value);
    EXPECT_EQ(value, 1);
    const GLuint hits = 1;
    gl().GetActiveUniformsiv(c, name_, 1, &hits, GL_UNIFORM_ATOMIC_COUNTER_BUFFER_INDEX, &value);
    EXPECT_EQ(value, 0);
    gl().GetActiveUniformsiv(c, name_, 1, &hits, GL_UNIFORM_OFFSET, &value);
    EXPECT_EQ(value, 8);
}

TEST_F(ShaderMemoryTest, BlocksOfStorageHavePlaces) {
    gl().ShaderStorageBlockBinding(c, name_, 1, 7);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(program_->executable->storage_blocks[1].binding, 7u);
    gl().ShaderStorageBlockBinding(c, name_, 2, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().ShaderStorageBlockBinding(c, name_, 0, el::storage_buffer::count);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    const GLuint made = buffer(GL_SHADER_STORAGE_BUFFER);
    gl().BindBufferRange(c, GL_SHADER_STORAGE_BUFFER, 7, made, 16, 32);
    EXPECT_EQ(of_unit(7, GL_SHADER_STORAGE_BUFFER_BINDING), static_cast<GLint>(made));
    EXPECT_EQ(of_unit(7, GL_SHADER_STORAGE_BUFFER_START), 16);
    EXPECT_EQ(of_unit(7, GL_SHADER_STORAGE_BUFFER_SIZE), 32);
    gl().BindBufferRange(c, GL_ATOMIC_COUNTER_BUFFER, 0, made, 2, 32);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().DeleteBuffers(c, 1, &made);
    EXPECT_EQ(of_unit(7, GL_SHADER_STORAGE_BUFFER_BINDING), 0);
}

TEST_F(ShaderMemoryTest, OnlyWhatIsBoundAndNotOnlyReadIsWritten) {
    EXPECT_FALSE(writes_memory(c));
    gl().BindBufferBase(c, GL_SHADER_STORAGE_BUFFER, 1, buffer(GL_SHADER_STORAGE_BUFFER));
    EXPECT_EQ(written(), 0u);
    gl().BindBufferBase(c, GL_SHADER_STORAGE_BUFFER, 2, buffer(GL_SHADER_STORAGE_BUFFER));
    EXPECT_EQ(written(), 1u);
    gl().BindBufferBase(c, GL_ATOMIC_COUNTER_BUFFER, 4, buffer(GL_ATOMIC_COUNTER_BUFFER));
    EXPECT_EQ(written(), 2u);
    gl().BindImageTexture(c, 3, texture(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA8);
    EXPECT_EQ(written(), 2u);
    gl().BindImageTexture(c, 0, texture(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    gl().BindImageTexture(c, 1, texture(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    EXPECT_EQ(written(), 3u) << "no uniform names unit 1";
    EXPECT_TRUE(writes_memory(c));
    gl().UseProgram(c, 0);
    EXPECT_FALSE(writes_memory(c));
}

TEST_F(ShaderMemoryTest, WhatWasWrittenIsOnNodesOnly) {
    const GLuint picture = texture();
    gl().BindImageTexture(c, 0, picture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    const GLuint storage = buffer(GL_SHADER_STORAGE_BUFFER);
    gl().BindBufferBase(c, GL_SHADER_STORAGE_BUFFER, 2, storage);
    std::lock_guard lock(share->mutex);
    note_written(c);
    EXPECT_TRUE(share->textures.find(picture)->is_drawn());
    EXPECT_TRUE(share->buffers.find(storage)->is_drawn());
}

TEST_F(ShaderMemoryTest, ErrorsOfDispatches) {
    GLint size[3] = {};
    gl().GetProgramiv(c, name_, GL_COMPUTE_WORK_GROUP_SIZE, size);
    EXPECT_EQ(size[0], 8);
    EXPECT_EQ(size[1], 4);
    gl().DispatchCompute(c, 1, 1, 1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().DispatchCompute(c, 65536, 1, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().DispatchComputeIndirect(c, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "no buffer";
    buffer(GL_DISPATCH_INDIRECT_BUFFER);
    gl().DispatchComputeIndirect(c, 52);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().DispatchComputeIndirect(c, 56);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "behind the end";
    gl().DispatchComputeIndirect(c, 2);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().DispatchComputeIndirect(c, -4);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().UseProgram(c, 0);
    gl().DispatchCompute(c, 1, 1, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().MemoryBarrierByRegion(c, GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

}  // namespace
}  // namespace wall::client
