// SPDX-License-Identifier: MIT
#include "client_lib/context/param_commands.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "client_lib/context/assembly_binding.h"
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

/// Indices of an element, in a row.
struct Indices {
    unsigned first = 0, count = 1;
};

constexpr unsigned kCoordinates = 4, kCubeCoordinates = 3;

/// Of the active unit. GL_OES_texture_cube_map has a word for all that are for cube maps, and none for single ones.
std::optional<Indices> coordinates_of(const Context& c, GLenum lead) {
    const unsigned first = c.active_texture() * kCoordinates;
    if (lead == GL_TEXTURE_GEN_STR_OES && c.profile.is_es()) return Indices{first, kCubeCoordinates};
    return lead - GL_S < kCoordinates ? std::optional(Indices{first + (lead - GL_S)}) : std::nullopt;
}

/// The element's indices that a command's first argument means; nothing: it means none.
std::optional<Indices> indices_of(const Context& c, ParamFamily family, GLenum lead) {
    const auto below = [](unsigned i, unsigned count) { return i < count ? std::optional(Indices{i}) : std::nullopt; };
    if (family == ParamFamily::Light) return below(lead - GL_LIGHT0, el::light_ambient::count);
    if (family == ParamFamily::TexEnv) return Indices{c.active_texture()};
    if (family == ParamFamily::Material)
        return lead == GL_FRONT ? below(0, 2) : lead == GL_BACK ? below(1, 2) : std::nullopt;
    return family == ParamFamily::TexGen ? coordinates_of(c, lead) : Indices{};
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
    const auto indices = indices_of(c, family, lead);
    const ParamRow* row = find_row(family, target_of(family, lead), pname);
    if (!indices || !row || !row->set || is_removed(c, pname)) return c.error(GL_INVALID_ENUM);
    double v[4] = {};
    std::copy_n(values, row->components, v);
    for (unsigned i = 0; i < indices->count; ++i) row->set(c, indices->first + i, v);
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

/// False: nothing is answered.
template <class T>
bool get_any(Context& c, ParamFamily family, GLenum lead, GLenum pname, T* values) {
    if (lacks_unit(c, family, lead)) return false;
    const auto indices = indices_of(c, family, lead);
    const auto* entry = glstate::find_param(family, target_of(family, lead), pname);
    if (!indices || !entry) return c.error(GL_INVALID_ENUM), false;
    const std::uint32_t id = entry->id + indices->first;
    if (family == ParamFamily::Material) adopt_current_color(c);
    if constexpr (std::is_same_v<T, GLint>)
        if (entry->kind == glstate::ValueKind::real && family != ParamFamily::Material)
            return get_truncated(c, id, entry->components, values), true;
    glstate::read_components(c.state, id, 0, entry->kind, entry->components, values);
    return true;
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
    if (!c.profile.has_begin() && is_assembly_word(word)) return true;
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
void convert_fixed(ParamFamily family, GLenum pname, const GLfixed* from, GLfloat* to) {
    const ParamRow* row = find_row(family, std::nullopt, pname);
    if (!row) return;
    for (unsigned k = 0; k < row->components; ++k)
        to[k] = row->word ? static_cast<GLfloat>(from[k]) : glapi::from_fixed(from[k]);
}
void convert_to_fixed(ParamFamily family, GLenum pname, const GLfloat* from, GLfixed* to) {
    const ParamRow* row = find_row(family, std::nullopt, pname);
    if (!row) return;
    for (unsigned k = 0; k < row->components; ++k) to[k] = row->word ? to_int(from[k]) : glapi::to_fixed(from[k]);
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

void get_fixed_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, GLfixed* values) {
    GLfloat read[4] = {};
    if (get_any(c, family, lead, pname, read)) convert_to_fixed(family, pname, read, values);
}

void set_capability(Context& c, GLenum cap, bool on) {
    if (is_removed(c, cap)) return c.error(GL_INVALID_ENUM);
    if (cap == GL_TEXTURE_GEN_STR_OES && c.profile.is_es()) {
        for (unsigned i = 0; i < kCubeCoordinates; ++i) set_capability(c, GL_TEXTURE_GEN_S + i, on);
        return;
    }
    const CapRow* row = find_cap_row(cap);
    const bool fixed_function = !row || row->unit_stride != 0;
    if (fixed_function && !c.profile.has_fixed_function()) return c.error(GL_INVALID_ENUM);
    if (!row)
        return on ? api::EnableClientState(c, cap) : api::DisableClientState(c, cap);  // as GL_EXT_vertex_array had it
    if (row->unit_stride != 0 && !c.fixed_unit()) return lacks_switch(c, row->unit_stride);
    row->set(c, row->index + row->unit_stride * c.active_texture(), on ? 1 : 0);
}

GLboolean is_capability_set(Context& c, GLenum cap) {
    if (cap == GL_TEXTURE_GEN_STR_OES && c.profile.is_es()) return is_capability_set(c, GL_TEXTURE_GEN_S);
    if (cap == GL_POINT_SIZE_ARRAY_OES && c.profile.is_es1())
        return static_cast<GLboolean>(c.state.vertex_arrays.point_size_array.enabled);
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
    const bool only_cube = c.profile.is_es();
    if (!cube && (only_cube || (!linear && !sphere))) return c.error(GL_INVALID_ENUM);
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
