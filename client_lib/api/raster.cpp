// SPDX-License-Identifier: MIT
// The current raster position and what belongs to it (OpenGL 1.2.1, 2.12), computed here with the float operations of
// Mesa's _mesa_RasterPos in their order (raster_place.h). Of vertex shaders and programs a node says it.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "client_lib/context/ask_one.h"
#include "client_lib/context/assembly_binding.h"
#include "client_lib/context/context.h"
#include "client_lib/context/matrix.h"
#include "common/glstate/raster_place.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;
using glstate::RasterState;

float dot3(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
float dot4(const Vec4& a, const Vec4& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

void normalize(float* v) {
    const float length = std::sqrt(dot3(v, v));
    if (length <= 0) return;
    const float inverse_length = 1.0f / length;
    for (int i = 0; i < 3; ++i) v[i] *= inverse_length;
}

void add_scaled(float* to, float scale, const float* from) {
    for (int i = 0; i < 3; ++i) to[i] += scale * from[i];
}

Vec4 clamped(Vec4 color) {
    for (float& v : color) v = std::clamp(v, 0.0f, 1.0f);
    return color;
}

// ---- visibility ----

/// Clip planes are in eye coordinates; Mesa compares in clip coordinates.
bool in_user_planes(const glstate::State& s, const Vec4& clip) {
    FormedMatrix projection;
    bool inverted = false;
    Mat4 inverse_projection{};
    for (unsigned i = 0; i < s.transform.clip_plane_enabled.size(); ++i) {
        if (!s.transform.clip_plane_enabled[i]) continue;
        if (!inverted) {
            load(projection, s.matrix.projection);
            inverse_projection = inverse(projection);
            inverted = true;
        }
        if (dot4(clip, transform_plane(s.transform.clip_plane[i], inverse_projection)) < 0.0f) return false;
    }
    return true;
}

// ---- lighting ----

struct Shading {
    Vec4 color, specular;
};

Vec3 product(const Vec4& a, const Vec4& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }

/// A light as seen from the vertex.
struct Incidence {
    float to_light[3];
    float attenuation;
    bool positional;
    bool lit = true;  ///< false: outside the spot's cone
};

Incidence incidence(const glstate::LightsState& l, unsigned i, const Vec4& vertex) {
    Incidence out{};
    const Vec4& position = l.light_position[i];
    Vec3 spot = l.light_spot_direction[i];
    normalize(spot.data());
    const bool is_spot = l.light_spot_cutoff[i] != 180.0f;
    const auto cosine = std::max(static_cast<float>(std::cos(l.light_spot_cutoff[i] * M_PI / 180.0)), 0.0f);
    out.positional = position[3] != 0.0f;
    out.attenuation = 1;
    if (!out.positional) {
        for (int k = 0; k < 3; ++k) out.to_light[k] = position[k];
        normalize(out.to_light);
        if (is_spot) {
            const float along = -dot3(out.to_light, spot.data());
            out.attenuation = along > cosine ? std::pow(along, l.light_spot_exponent[i]) : 0.0f;
        }
        return out;
    }
    for (int k = 0; k < 3; ++k) out.to_light[k] = position[k] / position[3] - vertex[k];
    const float distance = std::sqrt(dot3(out.to_light, out.to_light));
    if (distance > 1.0e-6f)
        for (float& v : out.to_light) v *= 1.0f / distance;
    out.attenuation = 1.0f / (l.light_constant_attenuation[i] +
                              distance * (l.light_linear_attenuation[i] + distance * l.light_quadratic_attenuation[i]));
    if (is_spot) {
        const float along = -dot3(out.to_light, spot.data());
        if (along < cosine) out.lit = false;
        else out.attenuation *= std::pow(along, l.light_spot_exponent[i]);
    }
    return out;
}

/// The half-way vector between the light and the viewer.
void half_way(const glstate::LightsState& l, const Vec4& vertex, Incidence& light) {
    if (l.light_model_local_viewer) {
        float to_vertex[3] = {vertex[0], vertex[1], vertex[2]};
        normalize(to_vertex);
        for (int k = 0; k < 3; ++k) light.to_light[k] -= to_vertex[k];
    } else {
        light.to_light[2] += 1.0f;
    }
    normalize(light.to_light);
}

// Mesa takes the object coordinates for the vertex here, even where lights are in eye coordinates; so do we.
Shading shade(const glstate::State& s, const Vec4& vertex, const Vec3& normal) {
    const auto& l = s.lights;
    const auto& m = s.material;
    const bool separate = l.light_model_color_control == GL_SEPARATE_SPECULAR_COLOR;
    Shading out{{0, 0, 0, std::clamp(m.material_diffuse[0][3], 0.0f, 1.0f)}, {0, 0, 0, 1}};
    for (int k = 0; k < 3; ++k)
        out.color[k] = m.material_emission[0][k] + l.light_model_ambient[k] * m.material_ambient[0][k];
    for (unsigned i = 0; i < l.light_enabled.size(); ++i) {
        if (!l.light_enabled[i]) continue;
        Incidence light = incidence(l, i, vertex);
        if (!light.lit || light.attenuation < 1e-3f) continue;
        const Vec3 ambient = product(l.light_ambient[i], m.material_ambient[0]);
        const float n_dot_light = dot3(normal.data(), light.to_light);
        if (n_dot_light < 0.0f) {
            add_scaled(out.color.data(), light.attenuation, ambient.data());
            continue;
        }
        Vec3 diffuse = ambient, specular{};
        add_scaled(diffuse.data(), n_dot_light, product(l.light_diffuse[i], m.material_diffuse[0]).data());
        half_way(l, vertex, light);
        const float n_dot_half = dot3(normal.data(), light.to_light);
        if (n_dot_half > 0.0f) {
            const float shine = std::pow(n_dot_half, m.material_shininess[0]);
            const Vec3 gloss = product(l.light_specular[i], m.material_specular[0]);
            if (shine > 1.0e-10f) add_scaled(separate ? specular.data() : diffuse.data(), shine, gloss.data());
        }
        add_scaled(out.color.data(), light.attenuation, diffuse.data());
        add_scaled(out.specular.data(), light.attenuation, specular.data());
    }
    return {clamped(out.color), clamped(out.specular)};
}

// ---- texture coordinates ----

struct Generated {
    Vec4 object, eye;
    Vec3 normal, reflection;
    float sphere = 0;  ///< half of the inverse length for GL_SPHERE_MAP
};

void prepare_reflection(Generated& g) {
    float u[3] = {g.eye[0], g.eye[1], g.eye[2]};
    normalize(u);
    const float two_nu = 2.0f * dot3(g.normal.data(), u);
    for (int k = 0; k < 3; ++k) g.reflection[k] = u[k] - g.normal[k] * two_nu;
    const auto& r = g.reflection;
    const float m = r[0] * r[0] + r[1] * r[1] + (r[2] + 1.0f) * (r[2] + 1.0f);
    g.sphere = m > 0.0f ? 0.5f * (1.0f / std::sqrt(m)) : 0.0f;
}

float generated(const glstate::TextureGenState& t, unsigned at, unsigned coordinate, const Generated& g) {
    switch (t.tex_gen_mode[at]) {
        case GL_OBJECT_LINEAR: return dot4(g.object, t.tex_gen_object_plane[at]);
        case GL_EYE_LINEAR: return dot4(g.eye, t.tex_gen_eye_plane[at]);
        case GL_SPHERE_MAP: return g.reflection[coordinate % 3] * g.sphere + 0.5f;
        case GL_REFLECTION_MAP: return g.reflection[coordinate % 3];
        default: return g.normal[coordinate % 3];
    }
}

void set_texcoords(const glstate::State& s, const Generated& g, RasterState& raster) {
    for (unsigned unit = 0; unit < kTextureCoords; ++unit) {
        Vec4 coords = s.current.texcoord[unit];
        for (unsigned i = 0; i < 4; ++i)
            if (s.texture_gen.tex_gen_enabled[unit * 4 + i]) coords[i] = generated(s.texture_gen, unit * 4 + i, i, g);
        raster.raster_texcoord[unit] = transform_point(s.matrix.texture_matrix[unit], coords);
    }
}

// ----

bool needs_normal(const glstate::State& s) {
    const auto& generated = s.texture_gen.tex_gen_enabled;
    return s.lighting.lighting_enabled ||
           std::any_of(generated.begin(), generated.end(), [](glstate::Flag on) { return on != 0; });
}

/// Not normalized, as in Mesa.
Vec3 eye_normal(const glstate::State& s) {
    FormedMatrix modelview;
    load(modelview, s.matrix.modelview);
    const auto& n = s.current.normal;
    return transform_direction(transposed(inverse(modelview)), {n[0], n[1], n[2], 0});
}

/// One change of value id for all of it.
void assign(Context& c, const RasterState& raster) {
    c.state.raster = raster;
    c.state.ids.renew(static_cast<std::size_t>(glstate::Category::raster));
}

/// Where the vertex shader or program in use puts the vertex, and the values that it makes, as a node's driver has
/// them. Nothing: no node can say it.
std::optional<RasterState> ask_raster_position(Context& c, const Vec4& object) {
    const auto answer = ask_one_node(c, "glRasterPos", [&](wire::PackBuffer& buffer, RequestId request) {
        glapi::pack::RasterPosition(buffer, request, object[0], object[1], object[2], object[3]);
    });
    RasterState raster;
    if (!answer || answer->bytes.size() != sizeof raster) return std::nullopt;
    std::memcpy(&raster, answer->bytes.data(), sizeof raster);
    raster.raster_clip = {};  // of which camera it is is not known
    return raster;
}

/// Tiles look at what is drawn to the window otherwise than its own picture does, or would.
bool is_seen_elsewhere(Context& c) { return c.attached() && c.session().is_seen_elsewhere(c.draw_target()); }

/// A valid raster position is a hit while selecting, as a point at the same place would be.
void mark_hit(Context& c, const Vec4& object) {
    c.begin_primitive(GL_POINTS);
    Vertex4f(c, object[0], object[1], object[2], object[3]);
    c.end_primitive();
}

}  // namespace

void RasterPos4f(Context& c, GLfloat x, GLfloat y, GLfloat z, GLfloat w) {
    if (!may_use_assembly(c, glapi::AssemblyStage::vertex)) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    const glstate::State& s = c.state;
    RasterState raster = s.raster;
    const Vec4 object{x, y, z, w};
    if (c.shades_vertices() && c.attached()) {
        if (const auto asked = ask_raster_position(c, object)) {
            assign(c, *asked);
            if (asked->raster_position_valid && s.local.render_mode == GL_SELECT) mark_hit(c, object);
            return;
        }
    }
    const Vec4 eye = transform_point(s.matrix.modelview, object);
    const Vec4 clip = transform_point(s.matrix.projection, eye);
    const bool kept = in_user_planes(s, clip);
    raster.raster_position_valid = kept && glstate::in_view_volume(s, clip);
    raster.raster_clip = kept && is_seen_elsewhere(c) ? glstate::raster_clip(s, clip) : Vec4{};
    if (!raster.raster_position_valid && raster.raster_clip[3] == 0.0f) return assign(c, raster);
    raster.raster_position = glstate::window_position(s, clip);
    raster.raster_distance = s.fog.fog_coord_source == GL_FOG_COORDINATE
                                 ? s.current.fog_coord
                                 : std::sqrt(eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2]);
    Generated g{object, eye, {}, {}};
    if (needs_normal(s)) {
        g.normal = eye_normal(s);
        prepare_reflection(g);
    }
    if (s.lighting.lighting_enabled) {
        glstate::adopt_current_color(c.state);  // what of the material follows it
        const Shading shading = shade(s, object, g.normal);
        raster.raster_color = shading.color;
        raster.raster_secondary_color = shading.specular;
    } else {
        raster.raster_color = s.current.color;
        raster.raster_secondary_color = s.current.secondary_color;
    }
    set_texcoords(s, g, raster);
    assign(c, raster);
    if (raster.raster_position_valid && s.local.render_mode == GL_SELECT) mark_hit(c, object);
}

void WindowPos3f(Context& c, GLfloat x, GLfloat y, GLfloat z) {
    c.flush_block();
    const glstate::State& s = c.state;
    const auto near = static_cast<float>(s.transform.depth_range.near_value),
               far = static_cast<float>(s.transform.depth_range.far_value);
    RasterState raster = s.raster;
    raster.raster_position = {x, y, std::clamp(z, 0.0f, 1.0f) * (far - near) + near, 1.0f};
    raster.raster_position_valid = 1;
    raster.raster_clip = {};
    raster.raster_distance = s.fog.fog_coord_source == GL_FOG_COORDINATE ? s.current.fog_coord : 0.0f;
    raster.raster_color = clamped(s.current.color);
    raster.raster_secondary_color = clamped(s.current.secondary_color);
    raster.raster_texcoord = s.current.texcoord;
    assign(c, raster);
}

}  // namespace wall::client::api
