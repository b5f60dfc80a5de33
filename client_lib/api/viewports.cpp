// SPDX-License-Identifier: MIT
// Viewports, scissor boxes and depth ranges, of which there are several for geometry shaders to choose from
// (OpenGL 4.1, 2.20.1 and 4.1.2). Commands without an index are about all of them.
#include <algorithm>
#include <cstddef>
#include <span>

#include "client_lib/context/context.h"
#include "client_lib/context/indexed_values.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

/// As drivers clamp them.
glstate::Viewport clamped(Context& c, GLfloat x, GLfloat y, GLfloat width, GLfloat height) {
    const auto most = [&](std::size_t i) {
        return static_cast<GLfloat>(limit_of(c.caps(), GL_MAX_VIEWPORT_DIMS, 16384, i));
    };
    const auto low = static_cast<GLfloat>(limit_of(c.caps(), GL_VIEWPORT_BOUNDS_RANGE, -32768, 0)),
               high = static_cast<GLfloat>(limit_of(c.caps(), GL_VIEWPORT_BOUNDS_RANGE, 32767, 1));
    return {std::clamp(x, low, high), std::clamp(y, low, high), std::min(width, most(0)), std::min(height, most(1))};
}

glstate::DepthRange clamped(GLdouble near, GLdouble far) { return {std::clamp(near, 0., 1.), std::clamp(far, 0., 1.)}; }

/// Whether there are `count` from `first` on. False, and an error.
bool check(Context& c, GLuint first, GLsizei count) {
    const GLuint most = viewports_of(c);
    if (count >= 0 && first <= most && static_cast<GLuint>(count) <= most - first) return true;
    return c.error(GL_INVALID_VALUE), false;
}

}  // namespace

void Viewport(Context& c, GLint x, GLint y, GLsizei width, GLsizei height) {
    if (width < 0 || height < 0) return c.error(GL_INVALID_VALUE);
    set_everywhere<el::viewport, el::viewport_rest>(
        c, clamped(c, static_cast<GLfloat>(x), static_cast<GLfloat>(y), static_cast<GLfloat>(width),
                   static_cast<GLfloat>(height)));
}

void ViewportArrayv(Context& c, GLuint first, GLsizei count, const GLfloat* v) {
    if (!check(c, first, count)) return;
    for (GLsizei i = 0; i < count; ++i)
        if (v[4 * i + 2] < 0 || v[4 * i + 3] < 0) return c.error(GL_INVALID_VALUE);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i, v += 4)
        set_at<el::viewport, el::viewport_rest>(c, first + i, clamped(c, v[0], v[1], v[2], v[3]));
}

void ViewportIndexedf(Context& c, GLuint index, GLfloat x, GLfloat y, GLfloat width, GLfloat height) {
    const GLfloat v[] = {x, y, width, height};
    ViewportArrayv(c, index, 1, v);
}

void ViewportIndexedfv(Context& c, GLuint index, const GLfloat* v) { ViewportArrayv(c, index, 1, v); }

void ScissorArrayv(Context& c, GLuint first, GLsizei count, const GLint* v) {
    if (!check(c, first, count)) return;
    for (GLsizei i = 0; i < count; ++i)
        if (v[4 * i + 2] < 0 || v[4 * i + 3] < 0) return c.error(GL_INVALID_VALUE);
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i, v += 4)
        set_at<el::scissor, el::scissor_rest>(c, first + i, {v[0], v[1], v[2], v[3]});
}

void ScissorIndexed(Context& c, GLuint index, GLint x, GLint y, GLsizei width, GLsizei height) {
    const GLint v[] = {x, y, width, height};
    ScissorArrayv(c, index, 1, v);
}

void ScissorIndexedv(Context& c, GLuint index, const GLint* v) { ScissorArrayv(c, index, 1, v); }

void DepthRangeArrayv(Context& c, GLuint first, GLsizei count, const GLdouble* v) {
    if (!check(c, first, count)) return;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i, v += 2)
        set_at<el::depth_range, el::depth_range_rest>(c, first + i, clamped(v[0], v[1]));
}

// Only in OpenGL ES (GL_OES_viewport_array).
void DepthRangeArrayfvOES(Context& c, GLuint first, GLsizei count, const GLfloat* v) {
    if (!check(c, first, count)) return;
    for (GLuint i = 0; i < static_cast<GLuint>(count); ++i, v += 2)
        set_at<el::depth_range, el::depth_range_rest>(c, first + i, clamped(v[0], v[1]));
}

void DepthRangeIndexed(Context& c, GLuint index, GLdouble near, GLdouble far) {
    const GLdouble v[] = {near, far};
    DepthRangeArrayv(c, index, 1, v);
}

}  // namespace wall::client::api

// Each of an array is a command of its own in a list.
namespace wall::client::compile {

void ViewportArrayv(Context& c, GLuint first, GLsizei count, const GLfloat* v) {
    for (GLsizei i = 0; i < count; ++i, v += 4) c.table->ViewportIndexedfv(c, first + static_cast<GLuint>(i), v);
}
void ScissorArrayv(Context& c, GLuint first, GLsizei count, const GLint* v) {
    for (GLsizei i = 0; i < count; ++i, v += 4) c.table->ScissorIndexedv(c, first + static_cast<GLuint>(i), v);
}
void DepthRangeArrayv(Context& c, GLuint first, GLsizei count, const GLdouble* v) {
    for (GLsizei i = 0; i < count; ++i, v += 2)
        c.table->DepthRangeIndexed(c, first + static_cast<GLuint>(i), v[0], v[1]);
}

}  // namespace wall::client::compile

namespace wall::client::replay {

void ViewportArrayv(Context&, std::span<const std::byte>) {}
void ScissorArrayv(Context&, std::span<const std::byte>) {}
void DepthRangeArrayv(Context&, std::span<const std::byte>) {}

}  // namespace wall::client::replay
