// SPDX-License-Identifier: MIT
// The matrix stacks and the viewport (OpenGL 1.2.1, 2.10). Only the tops are state of the context; the rest is local.
#include "client_lib/context/matrix.h"

#include <algorithm>

#include "client_lib/context/context.h"
#include "client_lib/context/limits.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

void tell_origin(Context& c, const FormedMatrix& modelview) {
    glstate::ModelviewOrigin origin;
    if (!needs_origin(modelview) || !describe_origin(modelview, origin)) return;
    c.set<el::modelview_base>(0, origin.base);
    for (unsigned i = 0; i < el::modelview_step::count; ++i) c.set<el::modelview_step>(i, origin.steps[i]);
    c.set<el::modelview_form>(0, origin.form);
}

template <class E, class Change>
void change_element(Context& c, unsigned i, MatrixStack& stack, Change&& change) {
    FormedMatrix top{c.get<E>(i), stack.form, stack.origin};
    change(stack, top);
    stack.form = top.form;
    stack.origin = top.origin;
    c.set<E>(i, top.m);
    if constexpr (E::id == el::modelview::id) tell_origin(c, top);
}

/// Runs `change(stack, top)` on the stack that glMatrixMode selected.
template <class Change>
void change_top(Context& c, Change&& change) {
    const unsigned unit = c.active_texture();
    if (c.state.local.matrix_mode == GL_MODELVIEW)
        return change_element<el::modelview>(c, 0, c.modelview_stack, change);
    if (c.state.local.matrix_mode == GL_PROJECTION)
        return change_element<el::projection>(c, 0, c.projection_stack, change);
    if (const auto i = program_matrix_of(c.state.local.matrix_mode))
        return change_element<el::program_matrix>(c, *i, c.program_stacks[*i], change);
    if (!c.fixed_unit()) return c.error(GL_INVALID_OPERATION);
    change_element<el::texture_matrix>(c, unit, c.texture_stacks[unit], change);
}

template <class Change>
void change_matrix(Context& c, Change&& change) {
    change_top(c, [&](MatrixStack&, FormedMatrix& top) { change(top); });
}

template <class T>
Mat4 to_matrix(const T* values) {
    Mat4 m;
    for (std::size_t i = 0; i < 16; ++i) m[i] = static_cast<float>(values[i]);
    return m;
}

template <class T>
void load_values(Context& c, const T* values, bool transpose) {
    if (!values) return;
    const Mat4 m = transpose ? transposed(to_matrix(values)) : to_matrix(values);
    change_matrix(c, [&](FormedMatrix& top) { load(top, m); });
}

template <class T>
void multiply_values(Context& c, const T* values, bool transpose) {
    if (!values) return;
    const Mat4 m = transpose ? transposed(to_matrix(values)) : to_matrix(values);
    change_matrix(c, [&](FormedMatrix& top) { multiply(top, m); });
}

}  // namespace

void MatrixMode(Context& c, GLenum mode) {
    const bool of_programs = c.profile.has_begin() && program_matrix_of(mode);
    if (mode != GL_MODELVIEW && mode != GL_PROJECTION && mode != GL_TEXTURE && !of_programs)
        return c.error(GL_INVALID_ENUM);
    c.set<el::matrix_mode>(0, mode);
}

void PushMatrix(Context& c) {
    change_top(c, [&](MatrixStack& stack, FormedMatrix& top) {
        if (stack.below.size() + 1 >= stack.limit) return c.error(GL_STACK_OVERFLOW);
        determine_form(top);
        stack.below.push_back(top);
    });
}

void PopMatrix(Context& c) {
    change_top(c, [&](MatrixStack& stack, FormedMatrix& top) {
        if (stack.below.empty()) return c.error(GL_STACK_UNDERFLOW);
        top = stack.below.back();
        stack.below.pop_back();
    });
}

void LoadIdentity(Context& c) {
    change_matrix(c, [](FormedMatrix& top) { load_identity(top); });
}

void LoadMatrixf(Context& c, const GLfloat* m) { load_values(c, m, false); }
void LoadMatrixd(Context& c, const GLdouble* m) { load_values(c, m, false); }
void LoadTransposeMatrixf(Context& c, const GLfloat* m) { load_values(c, m, true); }
void LoadTransposeMatrixd(Context& c, const GLdouble* m) { load_values(c, m, true); }
void MultMatrixf(Context& c, const GLfloat* m) { multiply_values(c, m, false); }
void MultMatrixd(Context& c, const GLdouble* m) { multiply_values(c, m, false); }
void MultTransposeMatrixf(Context& c, const GLfloat* m) { multiply_values(c, m, true); }
void MultTransposeMatrixd(Context& c, const GLdouble* m) { multiply_values(c, m, true); }

void Rotatef(Context& c, GLfloat angle, GLfloat x, GLfloat y, GLfloat z) {
    change_matrix(c, [&](FormedMatrix& top) { rotate(top, angle, x, y, z); });
}

void Scalef(Context& c, GLfloat x, GLfloat y, GLfloat z) {
    change_matrix(c, [&](FormedMatrix& top) { scale(top, x, y, z); });
}

void Translatef(Context& c, GLfloat x, GLfloat y, GLfloat z) {
    change_matrix(c, [&](FormedMatrix& top) { translate(top, x, y, z); });
}

void Frustum(Context& c, GLdouble left, GLdouble right, GLdouble bottom, GLdouble top, GLdouble near, GLdouble far) {
    const auto l = static_cast<float>(left), r = static_cast<float>(right), b = static_cast<float>(bottom),
               t = static_cast<float>(top);
    const auto n = static_cast<float>(near), f = static_cast<float>(far);
    if (n <= 0 || f <= 0 || n == f || l == r || t == b) return c.error(GL_INVALID_VALUE);
    change_matrix(c, [&](FormedMatrix& matrix) { frustum(matrix, l, r, b, t, n, f); });
}

void Ortho(Context& c, GLdouble left, GLdouble right, GLdouble bottom, GLdouble top, GLdouble near, GLdouble far) {
    const auto l = static_cast<float>(left), r = static_cast<float>(right), b = static_cast<float>(bottom),
               t = static_cast<float>(top);
    const auto n = static_cast<float>(near), f = static_cast<float>(far);
    if (l == r || b == t || n == f) return c.error(GL_INVALID_VALUE);
    change_matrix(c, [&](FormedMatrix& matrix) { ortho(matrix, l, r, b, t, n, f); });
}

}  // namespace wall::client::api
