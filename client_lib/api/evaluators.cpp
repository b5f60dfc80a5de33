// SPDX-License-Identifier: MIT
// Evaluators (OpenGL 1.2.1, 5.1). The maps are kept here and told to a node that lacks them; evaluating is the node's
// driver's. What an evaluated vertex touches is not computed: it goes to every tile.
#include <cmath>
#include <cstring>
#include <optional>

#include "client_lib/context/context.h"
#include "client_lib/objects/maps.h"
#include "client_lib/objects/texture.h"

namespace wall::client::api {
namespace {

using glapi::Op;

/// One parameter's part of a map's shape.
template <class T>
struct Axis {
    T from, to;
    GLint stride, order;
};

template <class T>
bool good_axis(const Axis<T>& axis, GLint components) {
    return axis.from != axis.to && axis.order >= 1 && axis.order <= kMaxEvaluatorOrder && axis.stride >= components;
}

/// Errors of both kinds of map, in Mesa's order; the map if there are none.
template <class T>
bool check(Context& c, unsigned map, const T* points, std::initializer_list<Axis<T>> axes) {
    for (const Axis<T>& axis : axes)
        if (axis.from == axis.to || axis.order < 1 || axis.order > kMaxEvaluatorOrder)
            return c.error(GL_INVALID_VALUE), false;
    if (!points) return c.error(GL_INVALID_VALUE), false;
    if (map >= kEvaluatorMaps) return c.error(GL_INVALID_ENUM), false;
    for (const Axis<T>& axis : axes)
        if (!good_axis(axis, static_cast<GLint>(evaluator_components(map)))) return c.error(GL_INVALID_VALUE), false;
    if (c.active_texture() != 0) return c.error(GL_INVALID_OPERATION), false;
    return true;
}

/// The control points as floats, u slowest, without gaps.
template <class T>
std::vector<float> tight_points(unsigned map, const T* points, const Axis<T>& u, const Axis<T>& v) {
    const unsigned components = evaluator_components(map);
    std::vector<float> out;
    out.reserve(static_cast<std::size_t>(u.order) * static_cast<std::size_t>(v.order) * components);
    for (GLint i = 0; i < u.order; ++i)
        for (GLint j = 0; j < v.order; ++j)
            for (unsigned k = 0; k < components; ++k)
                out.push_back(static_cast<float>(
                    points[static_cast<std::ptrdiff_t>(i) * u.stride + static_cast<std::ptrdiff_t>(j) * v.stride + k]));
    return out;
}

void changed(Context& c, EvaluatorMap& map) { c.maps->stamp = map.stamp = next_stamp(); }

template <class T>
void define1(Context& c, GLenum target, const Axis<T>& u, const T* points) {
    const unsigned i = target - GL_MAP1_COLOR_4;
    if (!check<T>(c, i, points, {u})) return;
    c.flush_block();
    EvaluatorMap& map = c.maps->map1[i];
    map.u_order = u.order;
    map.u1 = static_cast<float>(u.from);
    map.u2 = static_cast<float>(u.to);
    map.points = tight_points<T>(i, points, u, {0, 1, 0, 1});
    changed(c, map);
}

template <class T>
void define2(Context& c, GLenum target, const Axis<T>& u, const Axis<T>& v, const T* points) {
    const unsigned i = target - GL_MAP2_COLOR_4;
    if (!check<T>(c, i, points, {u, v})) return;
    c.flush_block();
    EvaluatorMap& map = c.maps->map2[i];
    map.u_order = u.order;
    map.v_order = v.order;
    map.u1 = static_cast<float>(u.from);
    map.u2 = static_cast<float>(u.to);
    map.v1 = static_cast<float>(v.from);
    map.v2 = static_cast<float>(v.to);
    map.points = tight_points<T>(i, points, u, v);
    changed(c, map);
}

template <class Out>
Out answer(float value) {
    if constexpr (std::is_same_v<Out, GLint>) return static_cast<GLint>(std::lrint(value));
    else return static_cast<Out>(value);
}

/// `room`: bytes that there are for it; nothing: the program did not say.
template <class Out>
void get_map(Context& c, GLenum target, GLenum query, Out* out, std::optional<GLsizei> room = std::nullopt) {
    const EvaluatorMap* one = c.maps->find1(target);
    const EvaluatorMap* two = one ? nullptr : c.maps->find2(target);
    const EvaluatorMap* map = one ? one : two;
    if (!map) return c.error(GL_INVALID_ENUM);
    const std::size_t axes = two ? 2 : 1;
    const std::size_t values = query == GL_COEFF ? map->points.size() : query == GL_ORDER ? axes : 2 * axes;
    if (room && (*room < 0 || static_cast<std::size_t>(*room) < values * sizeof(Out)))
        return c.error(GL_INVALID_OPERATION);
    const auto put = [&](float value) { *out++ = answer<Out>(value); };
    switch (query) {
        case GL_COEFF:
            for (const float value : map->points) put(value);
            break;
        case GL_ORDER:
            put(static_cast<float>(map->u_order));
            if (two) put(static_cast<float>(map->v_order));
            break;
        case GL_DOMAIN:
            put(map->u1), put(map->u2);
            if (two) put(map->v1), put(map->v2);
            break;
        default: c.error(GL_INVALID_ENUM);
    }
}

template <class... Values>
void pack(Context& c, Op op, Values... values) {
    std::byte* at = c.packer.append_rare(op, 4 * sizeof...(Values));
    ((std::memcpy(at, &values, 4), at += 4), ...);
    if (c.packer.inside()) c.packer.mark_unbounded();
}

}  // namespace

void Map1f(Context& c, GLenum target, GLfloat u1, GLfloat u2, GLint stride, GLint order, const GLfloat* points) {
    define1<GLfloat>(c, target, {u1, u2, stride, order}, points);
}
void Map1d(Context& c, GLenum target, GLdouble u1, GLdouble u2, GLint stride, GLint order, const GLdouble* points) {
    define1<GLdouble>(c, target, {u1, u2, stride, order}, points);
}
void Map2f(Context& c, GLenum target, GLfloat u1, GLfloat u2, GLint ustride, GLint uorder, GLfloat v1, GLfloat v2,
           GLint vstride, GLint vorder, const GLfloat* points) {
    define2<GLfloat>(c, target, {u1, u2, ustride, uorder}, {v1, v2, vstride, vorder}, points);
}
void Map2d(Context& c, GLenum target, GLdouble u1, GLdouble u2, GLint ustride, GLint uorder, GLdouble v1, GLdouble v2,
           GLint vstride, GLint vorder, const GLdouble* points) {
    define2<GLdouble>(c, target, {u1, u2, ustride, uorder}, {v1, v2, vstride, vorder}, points);
}

void GetMapfv(Context& c, GLenum target, GLenum query, GLfloat* v) { get_map(c, target, query, v); }
void GetMapdv(Context& c, GLenum target, GLenum query, GLdouble* v) { get_map(c, target, query, v); }
void GetMapiv(Context& c, GLenum target, GLenum query, GLint* v) { get_map(c, target, query, v); }
void GetnMapfv(Context& c, GLenum target, GLenum query, GLsizei room, GLfloat* v) {
    get_map(c, target, query, v, room);
}
void GetnMapdv(Context& c, GLenum target, GLenum query, GLsizei room, GLdouble* v) {
    get_map(c, target, query, v, room);
}
void GetnMapiv(Context& c, GLenum target, GLenum query, GLsizei room, GLint* v) { get_map(c, target, query, v, room); }

void EvalCoord1f(Context& c, GLfloat u) { pack(c, Op::EvalCoord1f, u); }
void EvalCoord2f(Context& c, GLfloat u, GLfloat v) { pack(c, Op::EvalCoord2f, u, v); }
void EvalPoint1(Context& c, GLint i) { pack(c, Op::EvalPoint1, i); }
void EvalPoint2(Context& c, GLint i, GLint j) { pack(c, Op::EvalPoint2, i, j); }

void EvalMesh1(Context& c, GLenum mode, GLint i1, GLint i2) {
    if (mode != GL_POINT && mode != GL_LINE) return c.error(GL_INVALID_ENUM);
    c.draw(std::nullopt, [&](wire::PackBuffer& buffer) { glapi::pack::EvalMesh1(buffer, mode, i1, i2); });
}

void EvalMesh2(Context& c, GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2) {
    if (mode != GL_POINT && mode != GL_LINE && mode != GL_FILL) return c.error(GL_INVALID_ENUM);
    c.draw(std::nullopt, [&](wire::PackBuffer& buffer) { glapi::pack::EvalMesh2(buffer, mode, i1, i2, j1, j2); });
}

}  // namespace wall::client::api
