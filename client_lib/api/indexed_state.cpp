// SPDX-License-Identifier: MIT
// State of single draw buffers and other indexed binding points (OpenGL 3.0, 4.1.8 and 4.2.2; EXT_draw_buffers2).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "client_lib/api/indexed_buffers.h"
#include "client_lib/context/context.h"
#include "client_lib/context/indexed_values.h"
#include "client_lib/context/limits.h"
#include "client_lib/context/object_name.h"
#include "client_lib/context/vertex_array_objects.h"
#include "client_lib/context/vertex_bindings.h"
#include "common/glstate/draw_buffers.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

GLuint draw_buffers(Context& c) { return draw_buffers_of(c); }

/// A field of how a draw buffer blends.
template <class E, class R, auto kField>
void blending(Context& c, GLuint index, double* out) {
    *out = glstate::value_at<E, R>(c.state, index).*kField;
}
template <auto kField>
constexpr auto kFunction = blending<el::blend_func, el::blend_func_rest, kField>;
template <auto kField>
constexpr auto kEquation = blending<el::blend_equation, el::blend_equation_rest, kField>;

/// A word that has a value for each index. What comes with bindings of buffers is a line here.
struct IndexedWord {
    GLenum word;
    bool cap;             ///< of glEnablei
    unsigned components;  ///< at most 4
    GLuint (*count)(Context&);
    void (*read)(Context&, GLuint index, double* out);
};

/// Of the compute shaders that nodes can run; the nodes' limit.
template <GLenum kWord>
void work_groups(Context& c, GLuint index, double* out) {
    *out = c.attached() ? limit_of(c.caps(), kWord, 0, index) : 0;
}
GLuint dimensions(Context&) { return 3; }

/// Of the buffers at indexed targets.
template <GLenum kWord>
void buffer_value(Context& c, GLuint index, double* out) {
    GLint64 value = 0;
    get_indexed_buffer(c, kWord, index, value);
    *out = static_cast<double>(value);  // no buffer is so large that it would be rounded
}
GLuint uniform_buffers(Context&) { return el::uniform_buffer::count; }
GLuint storage_buffers(Context&) { return el::storage_buffer::count; }
GLuint counter_buffers(Context&) { return el::counter_buffer::count; }
GLuint image_units(Context&) { return el::image_unit::count; }
template <auto kField>
void image_value(Context& c, GLuint unit, double* out) {
    *out = c.get<el::image_unit>(unit).*kField;
}
/// Of a unit that was never bound OpenGL ES says another one (OpenGL ES 3.1, table 20.32).
void image_format(Context& c, GLuint unit, double* out) {
    const glstate::ImageUnit& image = c.get<el::image_unit>(unit);
    const bool untouched = glstate::same(image, glstate::ImageUnit{0, 0, 0, 0, GL_READ_ONLY, GL_R8});
    *out = c.profile.is_es() && untouched ? GLenum{GL_R32UI} : image.format;
}
GLuint feedback_buffers(Context&) { return el::feedback_buffer::count; }

/// Of the places for buffers of the bound vertex array object.
template <auto kField>
void binding_value(Context& c, GLuint index, double* out) {
    const auto* own = c.vertex_array_objects->bindings.get();
    const VertexBindings bindings = own ? *own : bindings_of(c.state.vertex_arrays);
    *out = static_cast<double>(bindings.bindings[index].*kField);
}
void bound_buffer(Context& c, GLuint index, double* out) {
    binding_value<&VertexBinding::buffer>(c, index, out);
    *out = object_name(c, glstate::ValueKind::name_buffer, ClientName(static_cast<std::uint32_t>(*out)));
}
GLuint vertex_bindings(Context&) { return kVertexBindings; }

GLuint mask_words(Context&) { return 1; }

GLuint viewports(Context& c) { return viewports_of(c); }

void viewport_at(Context& c, GLuint i, double* out) {
    const glstate::Viewport& v = glstate::value_at<el::viewport, el::viewport_rest>(c.state, i);
    std::ranges::copy(std::array<double, 4>{v.x, v.y, v.width, v.height}, out);
}
void scissor_at(Context& c, GLuint i, double* out) {
    const glstate::Scissor& v = glstate::value_at<el::scissor, el::scissor_rest>(c.state, i);
    std::ranges::copy(std::array{double(v.x), double(v.y), double(v.width), double(v.height)}, out);
}
void depth_range_at(Context& c, GLuint i, double* out) {
    const glstate::DepthRange& v = glstate::value_at<el::depth_range, el::depth_range_rest>(c.state, i);
    out[0] = v.near_value, out[1] = v.far_value;
}

const IndexedWord kWords[] = {
    {GL_SCISSOR_TEST, true, 1, viewports,
     [](Context& c, GLuint i, double* out) { *out = c.state.window.scissor_enabled >> i & 1; }},
    {GL_VIEWPORT, false, 4, viewports, viewport_at},
    {GL_SCISSOR_BOX, false, 4, viewports, scissor_at},
    {GL_DEPTH_RANGE, false, 2, viewports, depth_range_at},
    {GL_BLEND, true, 1, draw_buffers,
     [](Context& c, GLuint i, double* out) { *out = c.state.color_buffer.blend_enabled >> i & 1; }},
    {GL_COLOR_WRITEMASK, false, 4, draw_buffers,
     [](Context& c, GLuint i, double* out) { std::ranges::copy(glstate::written_channels(c.state, i), out); }},
    {GL_BLEND_SRC_RGB, false, 1, draw_buffers, kFunction<&glstate::BlendFunc::src_rgb>},
    {GL_BLEND_DST_RGB, false, 1, draw_buffers, kFunction<&glstate::BlendFunc::dst_rgb>},
    {GL_BLEND_SRC_ALPHA, false, 1, draw_buffers, kFunction<&glstate::BlendFunc::src_alpha>},
    {GL_BLEND_DST_ALPHA, false, 1, draw_buffers, kFunction<&glstate::BlendFunc::dst_alpha>},
    {GL_BLEND_SRC, false, 1, draw_buffers, kFunction<&glstate::BlendFunc::src_rgb>},
    {GL_BLEND_DST, false, 1, draw_buffers, kFunction<&glstate::BlendFunc::dst_rgb>},
    {GL_BLEND_EQUATION_RGB, false, 1, draw_buffers, kEquation<&glstate::BlendEquation::rgb>},
    {GL_BLEND_EQUATION_ALPHA, false, 1, draw_buffers, kEquation<&glstate::BlendEquation::alpha>},
    {GL_SAMPLE_MASK_VALUE, false, 1, mask_words,
     [](Context& c, GLuint, double* out) { *out = c.get<el::sample_mask>(); }},
    {GL_UNIFORM_BUFFER_BINDING, false, 1, uniform_buffers, buffer_value<GL_UNIFORM_BUFFER_BINDING>},
    {GL_UNIFORM_BUFFER_START, false, 1, uniform_buffers, buffer_value<GL_UNIFORM_BUFFER_START>},
    {GL_UNIFORM_BUFFER_SIZE, false, 1, uniform_buffers, buffer_value<GL_UNIFORM_BUFFER_SIZE>},
    {GL_SHADER_STORAGE_BUFFER_BINDING, false, 1, storage_buffers, buffer_value<GL_SHADER_STORAGE_BUFFER_BINDING>},
    {GL_SHADER_STORAGE_BUFFER_START, false, 1, storage_buffers, buffer_value<GL_SHADER_STORAGE_BUFFER_START>},
    {GL_SHADER_STORAGE_BUFFER_SIZE, false, 1, storage_buffers, buffer_value<GL_SHADER_STORAGE_BUFFER_SIZE>},
    {GL_ATOMIC_COUNTER_BUFFER_BINDING, false, 1, counter_buffers, buffer_value<GL_ATOMIC_COUNTER_BUFFER_BINDING>},
    {GL_ATOMIC_COUNTER_BUFFER_START, false, 1, counter_buffers, buffer_value<GL_ATOMIC_COUNTER_BUFFER_START>},
    {GL_ATOMIC_COUNTER_BUFFER_SIZE, false, 1, counter_buffers, buffer_value<GL_ATOMIC_COUNTER_BUFFER_SIZE>},
    {GL_IMAGE_BINDING_NAME, false, 1, image_units,
     [](Context& c, GLuint unit, double* out) {
         *out = object_name(c, glstate::ValueKind::name_texture, ClientName(c.get<el::image_unit>(unit).texture));
     }},
    {GL_IMAGE_BINDING_LEVEL, false, 1, image_units, image_value<&glstate::ImageUnit::level>},
    {GL_IMAGE_BINDING_LAYERED, false, 1, image_units, image_value<&glstate::ImageUnit::layered>},
    {GL_IMAGE_BINDING_LAYER, false, 1, image_units, image_value<&glstate::ImageUnit::layer>},
    {GL_IMAGE_BINDING_ACCESS, false, 1, image_units, image_value<&glstate::ImageUnit::access>},
    {GL_IMAGE_BINDING_FORMAT, false, 1, image_units, image_format},
    {GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, false, 1, feedback_buffers,
     buffer_value<GL_TRANSFORM_FEEDBACK_BUFFER_BINDING>},
    {GL_TRANSFORM_FEEDBACK_BUFFER_START, false, 1, feedback_buffers, buffer_value<GL_TRANSFORM_FEEDBACK_BUFFER_START>},
    {GL_TRANSFORM_FEEDBACK_BUFFER_SIZE, false, 1, feedback_buffers, buffer_value<GL_TRANSFORM_FEEDBACK_BUFFER_SIZE>},
    {GL_VERTEX_BINDING_OFFSET, false, 1, vertex_bindings, binding_value<&VertexBinding::offset>},
    {GL_VERTEX_BINDING_STRIDE, false, 1, vertex_bindings, binding_value<&VertexBinding::stride>},
    {GL_VERTEX_BINDING_DIVISOR, false, 1, vertex_bindings, binding_value<&VertexBinding::divisor>},
    {GL_VERTEX_BINDING_BUFFER, false, 1, vertex_bindings, bound_buffer},
    {GL_MAX_COMPUTE_WORK_GROUP_COUNT, false, 1, dimensions, work_groups<GL_MAX_COMPUTE_WORK_GROUP_COUNT>},
    {GL_MAX_COMPUTE_WORK_GROUP_SIZE, false, 1, dimensions, work_groups<GL_MAX_COMPUTE_WORK_GROUP_SIZE>},
};

/// Null, and the error is set: there is none, or the index is none of its.
const IndexedWord* find_word(Context& c, GLenum word, GLuint index, bool cap) {
    const auto* found = std::ranges::find_if(kWords, [&](const auto& w) { return w.word == word && (w.cap || !cap); });
    if (found == std::end(kWords)) return c.error(GL_INVALID_ENUM), nullptr;
    if (index >= found->count(c)) return c.error(GL_INVALID_VALUE), nullptr;
    return found;
}

template <class Out>
void get(Context& c, GLenum word, GLuint index, Out* out) {
    const IndexedWord* found = find_word(c, word, index, false);
    if (!found) return;
    double values[4] = {};
    found->read(c, index, values);
    for (unsigned k = 0; k < found->components; ++k) {
        if constexpr (std::is_same_v<Out, GLboolean>) out[k] = values[k] != 0;
        else if constexpr (std::is_floating_point_v<Out>) out[k] = static_cast<Out>(values[k]);
        else out[k] = static_cast<Out>(std::llround(values[k]));
    }
}

void enable(Context& c, GLenum cap, GLuint index, bool on) {
    if (!find_word(c, cap, index, true)) return;
    if (cap == GL_BLEND) c.set<el::blend_enabled>(0, glstate::with_bit(c.get<el::blend_enabled>(), index, on));
    else c.set<el::scissor_enabled>(0, glstate::with_bit(c.get<el::scissor_enabled>(), index, on));
}

}  // namespace

void Enablei(Context& c, GLenum target, GLuint index) { enable(c, target, index, true); }
void Disablei(Context& c, GLenum target, GLuint index) { enable(c, target, index, false); }

GLboolean IsEnabledi(Context& c, GLenum target, GLuint index) {
    const IndexedWord* found = find_word(c, target, index, true);
    double value = 0;
    if (found) found->read(c, index, &value);
    return value != 0;
}

void ColorMaski(Context& c, GLuint index, GLboolean red, GLboolean green, GLboolean blue, GLboolean alpha) {
    if (index >= draw_buffers(c)) return c.error(GL_INVALID_VALUE);
    const glstate::ColorMask& now = c.get<el::color_mask>();
    c.set<el::color_mask>(
        0, {glstate::with_bit(now.red, index, red != 0), glstate::with_bit(now.green, index, green != 0),
            glstate::with_bit(now.blue, index, blue != 0), glstate::with_bit(now.alpha, index, alpha != 0)});
}

void GetBooleani_v(Context& c, GLenum target, GLuint index, GLboolean* data) { get(c, target, index, data); }
void GetIntegeri_v(Context& c, GLenum target, GLuint index, GLint* data) { get(c, target, index, data); }
void GetFloati_v(Context& c, GLenum target, GLuint index, GLfloat* data) { get(c, target, index, data); }
void GetDoublei_v(Context& c, GLenum target, GLuint index, GLdouble* data) { get(c, target, index, data); }
void GetInteger64i_v(Context& c, GLenum target, GLuint index, GLint64* data) { get(c, target, index, data); }

}  // namespace wall::client::api
