// SPDX-License-Identifier: MIT
#include "tileserver/driver/soft_maps.h"

#include <algorithm>

namespace wall::tileserver {
namespace {

// In the order of GL_MAP1_COLOR_4 ... GL_MAP1_VERTEX_4 (and GL_MAP2_*), which are consecutive.
constexpr std::array<std::size_t, kEvaluatorMaps> kComponents = {4, 1, 3, 1, 2, 3, 4, 3, 4};
// The initial control point (OpenGL 1.5, table 6.25).
constexpr std::array<std::array<float, 4>, kEvaluatorMaps> kInitialPoints = {
    {{1, 1, 1, 1}, {1}, {0, 0, 1}, {0}, {0, 0}, {0, 0, 0}, {0, 0, 0, 1}, {0, 0, 0}, {0, 0, 0, 1}}};

void emit_map1(const Gl& gl, std::size_t i, const EvaluatorMap& m) {
    const float* points = m.id == 0 ? kInitialPoints[i].data() : m.points.data();
    gl.Map1f(static_cast<GLenum>(GL_MAP1_COLOR_4 + i), m.u1, m.u2, static_cast<GLint>(kComponents[i]), m.u_order,
             points);
}
void emit_map2(const Gl& gl, std::size_t i, const EvaluatorMap& m) {
    const float* points = m.id == 0 ? kInitialPoints[i].data() : m.points.data();
    const auto components = static_cast<GLint>(kComponents[i]);
    gl.Map2f(static_cast<GLenum>(GL_MAP2_COLOR_4 + i), m.u1, m.u2, components * m.v_order, m.u_order, m.v1, m.v2,
             components, m.v_order, points);
}

}  // namespace

std::size_t evaluator_index(GLenum target, bool two_dimensional) {
    const GLenum first = two_dimensional ? GL_MAP2_COLOR_4 : GL_MAP1_COLOR_4;
    return target < first ? kEvaluatorMaps : std::min<std::size_t>(target - first, kEvaluatorMaps);
}
std::size_t evaluator_components(std::size_t index) { return kComponents[index]; }
std::size_t pixel_map_index(GLenum map) {
    return map < GL_PIXEL_MAP_I_TO_I ? kPixelMaps : std::min<std::size_t>(map - GL_PIXEL_MAP_I_TO_I, kPixelMaps);
}

void MapMirror::tell_evaluators(Driver& driver, const SoftMaps& maps) {
    const Gl& gl = driver.gl();
    driver.select_first_unit();  // glMap is an error elsewhere (OpenGL 1.2.1, F.2.13)
    for (std::size_t i = 0; i < kEvaluatorMaps; ++i) {
        if (map1_[i] != maps.map1[i].id) emit_map1(gl, i, maps.map1[i]);
        if (map2_[i] != maps.map2[i].id) emit_map2(gl, i, maps.map2[i]);
        map1_[i] = maps.map1[i].id;
        map2_[i] = maps.map2[i].id;
    }
    evaluators_initial_ = !maps.any_evaluator;
}

void MapMirror::sync_pixel_maps(const Gl& gl, const SoftMaps& maps) {
    if (!maps.any_pixel && pixel_initial_) return;
    constexpr float kInitial = 0;
    for (std::size_t i = 0; i < kPixelMaps; ++i) {
        const PixelMap& map = maps.pixel[i];
        if (pixel_[i] == map.id) continue;
        gl.PixelMapfv(static_cast<GLenum>(GL_PIXEL_MAP_I_TO_I + i),
                      map.id == 0 ? 1 : static_cast<GLsizei>(map.values.size()),
                      map.id == 0 ? &kInitial : map.values.data());
        pixel_[i] = map.id;
    }
    pixel_initial_ = !maps.any_pixel;
}

}  // namespace wall::tileserver
