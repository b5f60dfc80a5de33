// SPDX-License-Identifier: MIT
#include "client_lib/geometry/material.h"

#include <algorithm>
#include <iterator>

#include "common/glstate/diff.h"

namespace wall::client {
namespace {

namespace el = glstate::el;

template <class E>
typename E::type narrowed(const glstate::Vec4& value) {
    if constexpr (std::is_same_v<typename E::type, float>) return value[0];
    else {
        typename E::type v;
        for (std::size_t i = 0; i < v.size(); ++i) v[i] = value[i];
        return v;
    }
}

/// Calls `visit.template operator()<E>(face)` for each value that glMaterial would set.
template <class E, class Visit>
void visit_faces(const glstate::State& state, GLenum face, Visit& visit) {
    for (unsigned i = 0; i < 2; ++i) {
        const bool meant = face == GL_FRONT_AND_BACK || face == (i == 0 ? GLenum{GL_FRONT} : GLenum{GL_BACK});
        if (meant && !glstate::follows_color<E>(state, i)) visit.template operator()<E>(i);
    }
}

template <class Visit>
void visit_values(const glstate::State& state, GLenum face, GLenum pname, Visit&& visit) {
    const bool both = pname == GL_AMBIENT_AND_DIFFUSE;
    if (both || pname == GL_AMBIENT) visit_faces<el::material_ambient>(state, face, visit);
    if (both || pname == GL_DIFFUSE) visit_faces<el::material_diffuse>(state, face, visit);
    if (pname == GL_SPECULAR) visit_faces<el::material_specular>(state, face, visit);
    if (pname == GL_EMISSION) visit_faces<el::material_emission>(state, face, visit);
    if (pname == GL_SHININESS) visit_faces<el::material_shininess>(state, face, visit);
    if (pname == GL_COLOR_INDEXES) visit_faces<el::material_indexes>(state, face, visit);
}

constexpr GLenum kNames[] = {GL_AMBIENT,   GL_DIFFUSE,       GL_SPECULAR,           GL_EMISSION,
                             GL_SHININESS, GL_COLOR_INDEXES, GL_AMBIENT_AND_DIFFUSE};

}  // namespace

bool valid_material(GLenum face, GLenum pname) {
    return (face == GL_FRONT || face == GL_BACK || face == GL_FRONT_AND_BACK) &&
           std::find(std::begin(kNames), std::end(kNames), pname) != std::end(kNames);
}

bool changes_material(const glstate::State& state, GLenum face, GLenum pname, const glstate::Vec4& value) {
    bool changes = false;
    visit_values(state, face, pname, [&]<class E>(unsigned i) {
        changes = changes || !glstate::same(E::ref(state, i), narrowed<E>(value));
    });
    return changes;
}

void assign_material(glstate::State& state, GLenum face, GLenum pname, const glstate::Vec4& value) {
    visit_values(state, face, pname, [&]<class E>(unsigned i) { glstate::assign<E>(state, i, narrowed<E>(value)); });
}

}  // namespace wall::client
