// SPDX-License-Identifier: MIT
// Commands about objects by name that are more than the command about what is bound (GL_ARB_direct_state_access;
// OpenGL 4.5). The others are in commands.toml (`named`).
#include "client_lib/context/named_objects.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/capture_use.h"
#include "client_lib/context/framebuffer_binding.h"
#include "client_lib/context/object_name.h"
#include "client_lib/context/param_commands.h"
#include "client_lib/context/pixel_store.h"
#include "client_lib/context/vertex_array_objects.h"
#include "client_lib/objects/block_store.h"
#include "client_lib/objects/share_group.h"
#include "common/glapi/image.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

/// The buffer of a name; null: none of that name.
std::shared_ptr<Buffer> find_buffer(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return name == 0 ? nullptr : c.share().buffers.find(name);
}

}  // namespace

// ---- buffers ----

/// The one that is read is bound as well.
void CopyNamedBufferSubData(Context& c, GLuint from, GLuint to, GLintptr from_offset, GLintptr to_offset,
                            GLsizeiptr size) {
    const auto read = find_buffer(c, from);
    if (!read) return c.error(GL_INVALID_OPERATION);
    const NamedBuffer named(c, to);
    if (!named) return;
    c.buffers->by_id.try_emplace(read->id, read);
    const std::uint32_t before = c.state.local.copy_read_buffer;
    c.state.local.copy_read_buffer = read->id.value;
    CopyBufferSubData(c, GL_COPY_READ_BUFFER, named.target(), from_offset, to_offset, size);
    c.state.local.copy_read_buffer = before;
}

// ---- textures ----

void TextureParameterf(Context& c, GLuint name, GLenum pname, GLfloat param) {
    if (refuses_one_value(c, ParamFamily::TexParameter, pname)) return c.error(GL_INVALID_ENUM);
    TextureParameterfv(c, name, pname, &param);
}

void TextureParameteri(Context& c, GLuint name, GLenum pname, GLint param) {
    TextureParameterf(c, name, pname, static_cast<GLfloat>(param));
}

void TextureParameteriv(Context& c, GLuint name, GLenum pname, const GLint* params) {
    GLfloat values[4] = {};
    convert_params(ParamFamily::TexParameter, pname, params, values);
    TextureParameterfv(c, name, pname, values);
}

namespace {

struct SubImage {
    GLint level, x, y, z;
    GLsizei width, height, depth;
};

/// The faces of a cube map as slices of one image: calls `each(face's target, slice)`. False, and an error: there are
/// no such faces.
template <class Each>
bool for_each_face(Context& c, const glapi::TextureTargetInfo& info, const SubImage& part, Each&& each) {
    constexpr auto kFaces = static_cast<GLint>(glapi::kCubeFaces);
    if (part.z < 0 || part.z > kFaces || part.depth < 0 || part.depth > kFaces - part.z)
        return c.error(GL_INVALID_VALUE), false;
    for (GLint slice = 0; slice < part.depth; ++slice)
        each(glapi::image_target(info, static_cast<unsigned>(part.z + slice)), slice);
    return true;
}

const void* moved(const void* pixels, std::size_t bytes) {
    return reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(pixels) + bytes);  // or an offset of a buffer
}

bool is_cube(const NamedTexture& named) { return named.texture()->info.first_face != 0; }

}  // namespace

void TextureSubImage3D(Context& c, GLuint name, GLint level, GLint x, GLint y, GLint z, GLsizei width, GLsizei height,
                       GLsizei depth, GLenum format, GLenum type, const void* pixels) {
    const NamedTexture named(c, name);
    if (!named) return;
    if (!is_cube(named))
        return TexSubImage3D(c, named.target(), level, x, y, z, width, height, depth, format, type, pixels);
    const auto layout = glapi::pixel_layout(format, type);
    const glapi::PixelStore store = unpack_store(c.state);
    for_each_face(c, named.texture()->info, {level, x, y, z, width, height, depth}, [&](GLenum face, GLint slice) {
        std::size_t begin = 0;
        if (layout && width > 0 && height > 0)
            begin = glapi::row_offset(store, *layout, {width, height, depth, 3}, 0, slice) -
                    glapi::row_offset(store, *layout, {width, height, 1, 2}, 0, 0);
        TexSubImage2D(c, face, level, x, y, width, height, format, type, moved(pixels, begin));
    });
}

void CompressedTextureSubImage3D(Context& c, GLuint name, GLint level, GLint x, GLint y, GLint z, GLsizei width,
                                 GLsizei height, GLsizei depth, GLenum format, GLsizei bytes, const void* data) {
    const NamedTexture named(c, name);
    if (!named) return;
    if (!is_cube(named))
        return CompressedTexSubImage3D(c, named.target(), level, x, y, z, width, height, depth, format, bytes, data);
    const GLsizei face_bytes = depth > 0 ? bytes / depth : 0;
    const glapi::PixelStore store = unpack_store(c.state);
    if (const GLenum error = block_store_error(store, 3)) return c.error(error);
    const auto blocks = static_cast<GLint>(format);
    for_each_face(c, named.texture()->info, {level, x, y, z, width, height, depth}, [&](GLenum face, GLint slice) {
        std::size_t begin = 0;
        if (width > 0 && height > 0)
            begin = block_slice_offset(store, {blocks, {width, height, depth, 3}}, slice) -
                    block_slice_offset(store, {blocks, {width, height, 1, 2}}, 0);
        CompressedTexSubImage2D(c, face, level, x, y, width, height, format, face_bytes, moved(data, begin));
    });
}

void CopyTextureSubImage3D(Context& c, GLuint name, GLint level, GLint to_x, GLint to_y, GLint to_z, GLint x, GLint y,
                           GLsizei width, GLsizei height) {
    const NamedTexture named(c, name);
    if (!named) return;
    if (!is_cube(named)) return CopyTexSubImage3D(c, named.target(), level, to_x, to_y, to_z, x, y, width, height);
    for_each_face(c, named.texture()->info, {level, to_x, to_y, to_z, width, height, 1},
                  [&](GLenum face, GLint) { CopyTexSubImage2D(c, face, level, to_x, to_y, x, y, width, height); });
}

// ---- framebuffers ----

void BlitNamedFramebuffer(Context& c, GLuint read, GLuint draw, GLint from_x0, GLint from_y0, GLint from_x1,
                          GLint from_y1, GLint to_x0, GLint to_y0, GLint to_x1, GLint to_y1, GLbitfield mask,
                          GLenum filter) {
    const NamedFramebuffer from(c, read);
    if (!from) return;
    const auto source = c.framebuffers->read;
    const NamedFramebuffer to(c, draw);
    if (!to) return;
    bind_framebuffer(c, GL_READ_FRAMEBUFFER, source);
    BlitFramebuffer(c, from_x0, from_y0, from_x1, from_y1, to_x0, to_y0, to_x1, to_y1, mask, filter);
}

// ---- vertex arrays ----

void VertexArrayElementBuffer(Context& c, GLuint name, GLuint buffer_name) {
    const NamedVertexArray named(c, name);
    if (!named) return;
    const auto buffer = find_buffer(c, buffer_name);
    if (buffer_name != 0 && !buffer) return c.error(GL_INVALID_OPERATION);
    if (buffer) c.buffers->by_id.try_emplace(buffer->id, buffer);
    c.set<el::element_array_buffer>(0, buffer ? buffer->id.value : 0);
}

void GetVertexArrayiv(Context& c, GLuint name, GLenum pname, GLint* param) {
    const NamedVertexArray named(c, name);
    if (!named) return;
    if (pname != GL_ELEMENT_ARRAY_BUFFER_BINDING) return c.error(GL_INVALID_ENUM);
    *param = static_cast<GLint>(
        object_name(c, glstate::ValueKind::name_buffer, ClientName(c.state.vertex_arrays.element_array_buffer)));
}

void GetVertexArrayIndexediv(Context& c, GLuint name, GLuint index, GLenum pname, GLint* param) {
    const NamedVertexArray named(c, name);
    if (!named) return;
    if (pname == GL_VERTEX_BINDING_DIVISOR || pname == GL_VERTEX_BINDING_STRIDE || pname == GL_VERTEX_BINDING_BUFFER)
        return GetIntegeri_v(c, pname, index, param);
    if (pname == GL_CURRENT_VERTEX_ATTRIB || pname == GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING)
        return c.error(GL_INVALID_ENUM);
    GetVertexAttribiv(c, index, pname, param);
}

void GetVertexArrayIndexed64iv(Context& c, GLuint name, GLuint index, GLenum pname, GLint64* param) {
    const NamedVertexArray named(c, name);
    if (!named) return;
    if (pname != GL_VERTEX_BINDING_OFFSET) return c.error(GL_INVALID_ENUM);
    GetInteger64i_v(c, pname, index, param);
}

// ---- transform feedback ----

namespace {

/// Null, and an error: there is none of that name.
std::shared_ptr<FeedbackObject> find_feedback(Context& c, GLuint name) {
    auto object = c.captures->find(name);
    if (!object) c.error(GL_INVALID_OPERATION);
    return object;
}

glstate::BufferRange range_of(const Context& c, const FeedbackObject& object, GLuint index) {
    return &object == &c.captures->bound() ? c.get<el::feedback_buffer>(index) : object.buffers[index];
}

void set_feedback_buffer(Context& c, GLuint name, GLuint index, GLuint buffer_name, const glstate::BufferRange& part) {
    const auto object = find_feedback(c, name);
    if (!object) return;
    const auto buffer = find_buffer(c, buffer_name);
    if ((buffer_name != 0 && !buffer) || index >= kCaptureBuffers) return c.error(GL_INVALID_VALUE);
    if (object->active) return c.error(GL_INVALID_OPERATION);
    glstate::BufferRange range;
    if (buffer) {
        c.buffers->by_id.try_emplace(buffer->id, buffer);
        range = {buffer->id.value, part.offset, part.size};
    }
    if (object.get() == &c.captures->bound()) c.set<el::feedback_buffer>(index, range);
    else object->buffers[index] = range;
}

/// Nothing: no such word.
std::optional<GLint64> feedback_value(Context& c, const glstate::BufferRange& range, GLenum pname) {
    switch (pname) {
        case GL_TRANSFORM_FEEDBACK_BUFFER_BINDING:
            return object_name(c, glstate::ValueKind::name_buffer, ClientName(range.buffer));
        case GL_TRANSFORM_FEEDBACK_BUFFER_START: return range.offset;
        case GL_TRANSFORM_FEEDBACK_BUFFER_SIZE: return range.size;
        default: return std::nullopt;
    }
}

template <class Out>
void get_feedback(Context& c, GLuint name, GLenum pname, GLuint index, Out* param) {
    const auto object = find_feedback(c, name);
    if (!object) return;
    if (index >= kCaptureBuffers) return c.error(GL_INVALID_VALUE);
    const auto value = feedback_value(c, range_of(c, *object, index), pname);
    if (!value) return c.error(GL_INVALID_ENUM);
    *param = static_cast<Out>(*value);
}

}  // namespace

void TransformFeedbackBufferBase(Context& c, GLuint name, GLuint index, GLuint buffer) {
    set_feedback_buffer(c, name, index, buffer, {});
}

void TransformFeedbackBufferRange(Context& c, GLuint name, GLuint index, GLuint buffer, GLintptr offset,
                                  GLsizeiptr bytes) {
    constexpr GLsizeiptr kMost = ~std::uint32_t{0};
    if (offset < 0 || bytes < 0 || (buffer != 0 && bytes == 0) || offset % 4 != 0 || bytes % 4 != 0)
        return c.error(GL_INVALID_VALUE);
    set_feedback_buffer(
        c, name, index, buffer,
        {0, static_cast<std::uint32_t>(std::min(offset, kMost)), static_cast<std::uint32_t>(std::min(bytes, kMost))});
}

void GetTransformFeedbackiv(Context& c, GLuint name, GLenum pname, GLint* param) {
    const auto object = find_feedback(c, name);
    if (!object) return;
    if (pname == GL_TRANSFORM_FEEDBACK_PAUSED) *param = object->paused;
    else if (pname == GL_TRANSFORM_FEEDBACK_ACTIVE) *param = object->active != nullptr;
    else c.error(GL_INVALID_ENUM);
}
void GetTransformFeedbacki_v(Context& c, GLuint name, GLenum pname, GLuint index, GLint* param) {
    if (pname != GL_TRANSFORM_FEEDBACK_BUFFER_BINDING) return c.error(GL_INVALID_ENUM);
    get_feedback(c, name, pname, index, param);
}
void GetTransformFeedbacki64_v(Context& c, GLuint name, GLenum pname, GLuint index, GLint64* param) {
    if (pname == GL_TRANSFORM_FEEDBACK_BUFFER_BINDING) return c.error(GL_INVALID_ENUM);
    get_feedback(c, name, pname, index, param);
}

}  // namespace wall::client::api
