// SPDX-License-Identifier: MIT
// State of single draw buffers and other indexed binding points (OpenGL 3.0, 4.1.8 and 4.2.2; EXT_draw_buffers2).
#include <algorithm>
#include <cstdint>
#include <optional>

#include "client_lib/api/indexed_buffers.h"
#include "client_lib/context/context.h"
#include "client_lib/context/limits.h"
#include "common/glstate/draw_buffers.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

GLuint draw_buffers(Context& c) {
    constexpr auto kMost = static_cast<double>(glstate::kDrawBuffers);
    if (!c.attached()) return glstate::kDrawBuffers;
    return static_cast<GLuint>(std::min(kMost, limit_of(c.caps(), GL_MAX_DRAW_BUFFERS, kMost)));
}

/// A word that has a value for each index. What comes with bindings of buffers is a line here.
struct IndexedWord {
    GLenum word;
    bool cap;             ///< of glEnablei
    unsigned components;  ///< at most 4
    GLuint (*count)(Context&);
    void (*read)(Context&, GLuint index, std::int64_t* out);
};

/// Of the compute shaders that nodes can run; the nodes' limit.
template <GLenum kWord>
void work_groups(Context& c, GLuint index, std::int64_t* out) {
    *out = c.attached() ? static_cast<std::int64_t>(limit_of(c.caps(), kWord, 0, index)) : 0;
}
GLuint dimensions(Context&) { return 3; }

/// Of the buffers at indexed targets.
template <GLenum kWord>
void buffer_value(Context& c, GLuint index, std::int64_t* out) {
    GLint64 value = 0;
    get_indexed_buffer(c, kWord, index, value);
    *out = value;
}
GLuint uniform_buffers(Context&) { return el::uniform_buffer::count; }
GLuint feedback_buffers(Context&) { return el::feedback_buffer::count; }

GLuint mask_words(Context&) { return 1; }

const IndexedWord kWords[] = {
    {GL_BLEND, true, 1, draw_buffers,
     [](Context& c, GLuint i, std::int64_t* out) { *out = c.state.color_buffer.blend_enabled >> i & 1; }},
    {GL_COLOR_WRITEMASK, false, 4, draw_buffers,
     [](Context& c, GLuint i, std::int64_t* out) { std::ranges::copy(glstate::written_channels(c.state, i), out); }},
    {GL_SAMPLE_MASK_VALUE, false, 1, mask_words,
     [](Context& c, GLuint, std::int64_t* out) { *out = c.get<el::sample_mask>(); }},
    {GL_UNIFORM_BUFFER_BINDING, false, 1, uniform_buffers, buffer_value<GL_UNIFORM_BUFFER_BINDING>},
    {GL_UNIFORM_BUFFER_START, false, 1, uniform_buffers, buffer_value<GL_UNIFORM_BUFFER_START>},
    {GL_UNIFORM_BUFFER_SIZE, false, 1, uniform_buffers, buffer_value<GL_UNIFORM_BUFFER_SIZE>},
    {GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, false, 1, feedback_buffers,
     buffer_value<GL_TRANSFORM_FEEDBACK_BUFFER_BINDING>},
    {GL_TRANSFORM_FEEDBACK_BUFFER_START, false, 1, feedback_buffers, buffer_value<GL_TRANSFORM_FEEDBACK_BUFFER_START>},
    {GL_TRANSFORM_FEEDBACK_BUFFER_SIZE, false, 1, feedback_buffers, buffer_value<GL_TRANSFORM_FEEDBACK_BUFFER_SIZE>},
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
    std::int64_t values[4] = {};
    found->read(c, index, values);
    for (unsigned k = 0; k < found->components; ++k) {
        if constexpr (std::is_same_v<Out, GLboolean>) out[k] = values[k] != 0;
        else out[k] = static_cast<Out>(values[k]);
    }
}

void enable(Context& c, GLenum cap, GLuint index, bool on) {
    if (!find_word(c, cap, index, true)) return;
    c.set<el::blend_enabled>(0, glstate::with_bit(c.get<el::blend_enabled>(), index, on));
}

}  // namespace

void Enablei(Context& c, GLenum target, GLuint index) { enable(c, target, index, true); }
void Disablei(Context& c, GLenum target, GLuint index) { enable(c, target, index, false); }

GLboolean IsEnabledi(Context& c, GLenum target, GLuint index) {
    const IndexedWord* found = find_word(c, target, index, true);
    std::int64_t value = 0;
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
void GetInteger64i_v(Context& c, GLenum target, GLuint index, GLint64* data) { get(c, target, index, data); }

}  // namespace wall::client::api
