// SPDX-License-Identifier: MIT
#include "client_lib/context/param_commands.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "client_lib/context/context.h"
#include "client_lib/context/matrix.h"
#include "common/glstate/diff.h"
#include "common/glstate/queries.h"

namespace wall::client {
namespace {

namespace el = glstate::el;

/// No target: any.
const ParamRow* find_row(ParamFamily family, std::optional<GLenum> target, GLenum pname) {
    for (const ParamRow& row : kParamRows) {
        if (row.family != family || (target && row.target != *target)) continue;
        if (row.pname == pname || row.pname == kAnyParam) return &row;
    }
    return nullptr;
}

/// The element's index that a command's first argument means; nothing: it means none.
std::optional<unsigned> index_of(const Context& c, ParamFamily family, GLenum lead) {
    const auto below = [](unsigned i, unsigned count) { return i < count ? std::optional(i) : std::nullopt; };
    if (family == ParamFamily::Light) return below(lead - GL_LIGHT0, el::light_ambient::count);
    if (family == ParamFamily::TexEnv) return c.active_texture();
    if (family == ParamFamily::Material)
        return lead == GL_FRONT ? std::optional(0u) : lead == GL_BACK ? std::optional(1u) : std::nullopt;
    if (family != ParamFamily::TexGen) return 0;
    const auto coordinate = below(lead - GL_S, 4);
    return coordinate ? std::optional(c.active_texture() * 4 + *coordinate) : std::nullopt;
}

GLenum target_of(ParamFamily family, GLenum lead) { return family == ParamFamily::TexEnv ? lead : 0; }

template <class T>
void convert(ParamFamily family, GLenum pname, const T* from, GLfloat* to) {
    const ParamRow* row = find_row(family, std::nullopt, pname);
    if (!row) return;
    for (unsigned k = 0; k < row->components; ++k)
        to[k] = row->normalized ? glapi::to_fraction(from[k]) : static_cast<GLfloat>(from[k]);
}

/// Texture units that only samplers name have no environment, and generate no coordinates. As in Mesa, the first is not
/// an error.
bool lacks_unit(Context& c, ParamFamily family, GLenum lead) {
    const bool coordinates = family == ParamFamily::TexGen || lead == GL_POINT_SPRITE;
    if ((family != ParamFamily::TexEnv && family != ParamFamily::TexGen) || c.fixed_unit()) return false;
    if (coordinates) c.error(GL_INVALID_OPERATION);
    return true;
}

template <class T>
void set_any(Context& c, ParamFamily family, GLenum lead, GLenum pname, const T* values) {
    if (lacks_unit(c, family, lead)) return;
    const auto index = index_of(c, family, lead);
    const ParamRow* row = find_row(family, target_of(family, lead), pname);
    if (!index || !row || !row->set || is_removed(c, pname)) return c.error(GL_INVALID_ENUM);
    double v[4] = {};
    std::copy_n(values, row->components, v);
    row->set(c, *index, v);
}

/// Material parameters that follow the current colour get it.
void adopt_current_color(Context& c) {
    c.flush_block();
    glstate::adopt_current_color(c.state);
}

/// Mesa rounds what glGetIntegerv and glGetMaterialiv answer, but cuts off here.
void get_truncated(const Context& c, std::uint32_t id, unsigned components, GLint* values) {
    GLfloat real[4];
    glstate::read_components(c.state, id, 0, glstate::ValueKind::real, components, real);
    std::transform(real, real + components, values, [](GLfloat v) { return to_int(v); });
}

template <class T>
void get_any(Context& c, ParamFamily family, GLenum lead, GLenum pname, T* values) {
    if (lacks_unit(c, family, lead)) return;
    const auto index = index_of(c, family, lead);
    const auto* entry = glstate::find_param(family, target_of(family, lead), pname);
    if (!index || !entry) return c.error(GL_INVALID_ENUM);
    if (family == ParamFamily::Material) adopt_current_color(c);
    if constexpr (std::is_same_v<T, GLint>)
        if (entry->kind == glstate::ValueKind::real && family != ParamFamily::Material)
            return get_truncated(c, entry->id + *index, entry->components, values);
    glstate::read_components(c.state, entry->id + *index, 0, entry->kind, entry->components, values);
}

/// Of a unit without fixed function. As in Mesa, only that of generated coordinates is an error.
void lacks_switch(Context& c, unsigned unit_stride) {
    constexpr unsigned kOfCoordinates = 4;
    if (unit_stride == kOfCoordinates) c.error(GL_INVALID_OPERATION);
}

const CapRow* find_cap_row(GLenum cap) {
    const auto at = std::lower_bound(kCapRows.begin(), kCapRows.end(), cap,
                                     [](const CapRow& row, GLenum word) { return row.cap < word; });
    return at != kCapRows.end() && at->cap == cap ? &*at : nullptr;
}

}  // namespace

bool is_removed(const Context& c, GLenum word) {
    return c.profile.core && std::ranges::binary_search(kRemovedWords, word);
}

unsigned param_components(ParamFamily family, GLenum pname) {
    const ParamRow* row = find_row(family, std::nullopt, pname);
    return row ? row->components : 0;
}

bool refuses_one_value(const Context& c, ParamFamily family, GLenum pname) {
    return c.at_once() && param_components(family, pname) > 1;
}

void convert_params(ParamFamily family, GLenum pname, const GLint* from, GLfloat* to) {
    convert(family, pname, from, to);
}
void convert_params(ParamFamily family, GLenum pname, const GLdouble* from, GLfloat* to) {
    convert(family, pname, from, to);
}
GLint rounded_param(GLfloat value) { return to_int(std::round(value)); }

void set_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, const GLfloat* values) {
    set_any(c, family, lead, pname, values);
}
void set_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, const GLint* values) {
    set_any(c, family, lead, pname, values);
}
void set_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, const GLenum* values) {
    set_any(c, family, lead, pname, values);
}

void get_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, GLfloat* values) {
    get_any(c, family, lead, pname, values);
}
void get_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, GLint* values) {
    get_any(c, family, lead, pname, values);
}
void get_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, GLdouble* values) {
    get_any(c, family, lead, pname, values);
}

void set_capability(Context& c, GLenum cap, bool on) {
    if (is_removed(c, cap)) return c.error(GL_INVALID_ENUM);
    const CapRow* row = find_cap_row(cap);
    const bool fixed_function = !row || row->unit_stride != 0;
    if (fixed_function && !c.profile.has_fixed_function()) return c.error(GL_INVALID_ENUM);
    if (!row)
        return on ? api::EnableClientState(c, cap) : api::DisableClientState(c, cap);  // as GL_EXT_vertex_array had it
    if (row->unit_stride != 0 && !c.fixed_unit()) return lacks_switch(c, row->unit_stride);
    row->set(c, row->index + row->unit_stride * c.active_texture(), on ? 1 : 0);
}

GLboolean is_capability_set(Context& c, GLenum cap) {
    const auto* entry = is_removed(c, cap) ? nullptr : glstate::find_get(cap);  // client arrays as well
    using enum glstate::ValueKind;
    const bool fixed_function =
        entry && !c.profile.has_fixed_function() && (entry->rule != glstate::IndexRule::none || !find_cap_row(cap));
    if (!entry || fixed_function || (entry->kind != flag && entry->kind != first_bit) || entry->components != 1) {
        c.error(GL_INVALID_ENUM);
        return GL_FALSE;
    }
    const unsigned unit = entry->rule == glstate::IndexRule::none ? 0
                          : entry->rule == glstate::IndexRule::client_unit
                              ? c.state.local.client_active_texture - GL_TEXTURE0
                              : c.active_texture();
    if (unit != 0 && unit >= entry->units) return lacks_switch(c, entry->unit_stride), GLboolean{GL_FALSE};
    GLboolean value = GL_FALSE;
    glstate::read_components(c.state, entry->id + unit * entry->unit_stride, entry->offset, entry->kind, 1, &value);
    return value;
}

// ---- parameters that go through the modelview matrix (OpenGL 1.2.1, 2.13.1 and 2.10.4), or depend on others ----

namespace hand {

void set_light_position(Context& c, unsigned i, const double* v) {
    c.set<el::light_position>(i, transform_point(c.get<el::modelview>(), vector<Vec4>(v)));
}

void set_light_spot_direction(Context& c, unsigned i, const double* v) {
    const Vec3 d = vector<Vec3>(v);
    c.set<el::light_spot_direction>(i, transform_direction(c.get<el::modelview>(), {d[0], d[1], d[2], 0}));
}

/// Q has no sphere, normal or reflection map, R no sphere map (OpenGL 1.3, 2.10.4).
void set_tex_gen_mode(Context& c, unsigned i, const double* v) {
    const GLenum mode = to_enum(v[0]);
    const unsigned coordinate = i % 4;
    const bool linear = mode == GL_OBJECT_LINEAR || mode == GL_EYE_LINEAR;
    const bool sphere = mode == GL_SPHERE_MAP && coordinate < 2;
    const bool cube = (mode == GL_NORMAL_MAP || mode == GL_REFLECTION_MAP) && coordinate < 3;
    if (!linear && !sphere && !cube) return c.error(GL_INVALID_ENUM);
    c.set<el::tex_gen_mode>(i, mode);
}

void set_tex_gen_eye_plane(Context& c, unsigned i, const double* v) {
    FormedMatrix modelview{c.get<el::modelview>(), c.modelview_stack.form};
    const Mat4 inverted = inverse(modelview);
    c.modelview_stack.form = modelview.form;
    c.set<el::tex_gen_eye_plane>(i, transform_plane(vector<Vec4>(v), inverted));
}

}  // namespace hand
}  // namespace wall::client
