// SPDX-License-Identifier: MIT
// Clip planes are given in object coordinates and kept in eye coordinates (OpenGL 1.2.1, 2.11). The matrix is the
// modelview of the call.
#include "client_lib/context/context.h"
#include "client_lib/context/matrix.h"

namespace wall::client {
namespace {

namespace el = glstate::el;

glstate::Vec4 to_vec4(const double* v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), static_cast<float>(v[3])};
}

/// The plane that holds for eye coordinates.
glstate::Vec4 eye_plane(Context& c, const double* plane) {
    FormedMatrix modelview{c.state.matrix.modelview, c.modelview_stack.form};
    const Mat4 to_object = inverse(modelview);
    c.modelview_stack.form = modelview.form;
    return transform_plane(to_vec4(plane), to_object);
}

}  // namespace

namespace api {

void ClipPlane(Context& c, GLenum plane, const GLdouble* equation) {
    const unsigned i = plane - GL_CLIP_PLANE0;
    if (i >= el::clip_plane::count) return c.error(GL_INVALID_ENUM);
    c.set<el::clip_plane>(i, eye_plane(c, equation));
}

}  // namespace api
}  // namespace wall::client
