// SPDX-License-Identifier: MIT
// What OpenGL ES 1.1 has of floats and of fixed point instead of doubles, where more than a number is converted (the
// rest is generated: proto/gl/commands.toml, `convert` and `param`).
#include <algorithm>
#include <array>
#include <cmath>

#include "client_lib/context/context.h"
#include "client_lib/context/param_commands.h"
#include "common/glapi/convert.h"

namespace wall::client::api {
namespace {

/// The values that `get` gives, which are as many, as what `convert` makes of them. Nothing is given after an error.
template <std::size_t kCount, class Out, class Get, class Convert>
void give(Out* out, Get&& get, Convert&& convert) {
    std::array<GLdouble, kCount> values;
    values.fill(std::numeric_limits<GLdouble>::quiet_NaN());
    get(values.data());
    if (!std::isnan(values[0])) std::ranges::transform(values, out, convert);
}

template <class Out, std::size_t kCount>
std::array<Out, kCount> from_fixed(const GLfixed* values) {
    std::array<Out, kCount> out;
    std::transform(values, values + kCount, out.begin(), glapi::from_fixed);
    return out;
}

const glstate::Mat4& current_matrix(const Context& c) {
    switch (c.state.local.matrix_mode) {
        case GL_MODELVIEW: return c.state.matrix.modelview;
        case GL_PROJECTION: return c.state.matrix.projection;
        default: return c.state.matrix.texture_matrix[c.fixed_unit() ? c.active_texture() : 0];
    }
}

}  // namespace

void ClipPlanef(Context& c, GLenum plane, const GLfloat* equation) {
    const std::array<GLdouble, 4> values{equation[0], equation[1], equation[2], equation[3]};
    ClipPlane(c, plane, values.data());
}
void ClipPlanex(Context& c, GLenum plane, const GLfixed* equation) {
    ClipPlane(c, plane, from_fixed<GLdouble, 4>(equation).data());
}

void GetClipPlanef(Context& c, GLenum plane, GLfloat* equation) {
    give<4>(
        equation, [&](GLdouble* values) { GetClipPlane(c, plane, values); },
        [](GLdouble value) { return static_cast<GLfloat>(value); });
}
void GetClipPlanex(Context& c, GLenum plane, GLfixed* equation) {
    give<4>(
        equation, [&](GLdouble* values) { GetClipPlane(c, plane, values); }, glapi::to_fixed);
}

void LoadMatrixx(Context& c, const GLfixed* m) {
    if (m) LoadMatrixf(c, from_fixed<GLfloat, 16>(m).data());
}
void MultMatrixx(Context& c, const GLfixed* m) {
    if (m) MultMatrixf(c, from_fixed<GLfloat, 16>(m).data());
}

/// GL_OES_query_matrix: each element is mantissa / 2^16 * 2^exponent; a bit of the result stands for each that is
/// infinite or no number.
GLbitfield QueryMatrixxOES(Context& c, GLfixed* mantissa, GLint* exponent) {
    GLbitfield unusual = 0;
    const glstate::Mat4& matrix = current_matrix(c);
    for (unsigned i = 0; i < matrix.size(); ++i) {
        int power = 0;
        const bool finite = std::isfinite(matrix[i]);
        const float fraction = finite                  ? std::frexp(matrix[i], &power)
                               : std::isnan(matrix[i]) ? 0
                               : matrix[i] > 0         ? 1
                                                       : -1;
        mantissa[i] = glapi::to_fixed(static_cast<GLdouble>(fraction));
        exponent[i] = power;
        if (!finite) unusual |= 1u << i;
    }
    return unusual;
}

void GetTexParameterxv(Context& c, GLenum target, GLenum pname, GLfixed* params) {
    std::array<GLfloat, 4> values;
    values.fill(std::numeric_limits<GLfloat>::quiet_NaN());
    GetTexParameterfv(c, target, pname, values.data());
    if (!std::isnan(values[0])) convert_to_fixed(ParamFamily::TexParameter, pname, values.data(), params);
}

}  // namespace wall::client::api
