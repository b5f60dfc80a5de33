// SPDX-License-Identifier: MIT
// What the generated state commands stand on: parameters by name (glFog*, glLight*, ...) and glEnable's words, by
// table. The tables are generated from proto/gl/state.toml. Used by the thread that has the context.
#pragma once

#include <cstdint>
#include <iterator>
#include <span>

#include "common/glapi/convert.h"
#include "common/glapi/gl_types.h"
#include "common/glstate/values.h"
#include "gen/glstate/tables.gen.h"

namespace wall::client {

class Context;
using glstate::ParamFamily;

inline constexpr GLenum kAnyParam = ~GLenum{0};

/// One parameter of a family of commands.
struct ParamRow {
    ParamFamily family;
    GLenum target;  ///< of glTexEnv; else 0
    GLenum pname;   ///< kAnyParam: all that have no row
    std::uint8_t components;
    bool normalized;                                     ///< integers map to [-1, 1]
    bool word;                                           ///< a word or a switch, no number
    void (*set)(Context&, unsigned i, const double* v);  ///< null: the command is written by hand
};
extern const std::span<const ParamRow> kParamRows;  ///< by family

/// One word of glEnable: element index `index`, plus the active unit times `unit_stride`.
struct CapRow {
    GLenum cap;
    void (*set)(Context&, unsigned i, glstate::Flag on);
    std::uint8_t index;
    std::uint8_t unit_stride;
};
extern const std::span<const CapRow> kCapRows;  ///< by cap

/// A core profile has no such word any more, or the context none of extensions that never were for its kind.
bool is_removed(const Context& c, GLenum word);

/// Values that a parameter takes; 0: no such parameter.
unsigned param_components(ParamFamily family, GLenum pname);
/// A command for one value that is called with a parameter of several. Display lists take it, with zeros for the
/// others, as Mesa does.
bool refuses_one_value(const Context& c, ParamFamily family, GLenum pname);
/// A parameter's values as floats, integers mapped to fractions where that parameter asks for it.
void convert_params(ParamFamily family, GLenum pname, const GLint* from, GLfloat* to);
void convert_params(ParamFamily family, GLenum pname, const GLdouble* from, GLfloat* to);
GLint rounded_param(GLfloat value);
/// The same of fixed point, which words and switches are given without (OpenGL ES 1.1, 2.3).
void convert_fixed(ParamFamily family, GLenum pname, const GLfixed* from, GLfloat* to);
/// The other way round.
void convert_to_fixed(ParamFamily family, GLenum pname, const GLfloat* from, GLfixed* to);

/// glX*v(lead, pname, values); raises the error itself. lead: light, target or coordinate; 0 where there is none.
void set_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, const GLfloat* values);
void set_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, const GLint* values);
void set_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, const GLenum* values);

/// glGetX*v(lead, pname, values).
void get_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, GLfloat* values);
void get_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, GLint* values);
void get_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, GLdouble* values);
void get_fixed_params(Context& c, ParamFamily family, GLenum lead, GLenum pname, GLfixed* values);

void set_capability(Context& c, GLenum cap, bool on);
GLboolean is_capability_set(Context& c, GLenum cap);

// ---- values, for the generated setters ----

template <std::size_t n>
bool one_of(GLenum value, const GLenum (&words)[n]) {
    for (const GLenum word : words)
        if (word == value) return true;
    return false;
}
template <class T>
T clamped(T value, T low, T high) {
    return value < low ? low : value > high ? high : value;
}
template <class T>
glstate::Flag to_flag(T value) {
    return value != 0 ? 1 : 0;
}
/// The value for all of `count` draw buffers, a bit each.
template <class T>
std::uint32_t all_or_none(T value, unsigned count) {
    return value != 0 ? (1u << count) - 1 : 0;
}
/// Zero for what is no int.
inline std::int32_t to_int(double v) {
    return v >= -2147483648.0 && v <= 2147483647.0 ? static_cast<std::int32_t>(v) : 0;
}
inline GLenum to_enum(double v) { return static_cast<GLenum>(to_int(v)); }
template <class Vector>
Vector vector(const double* v) {
    Vector out{};
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = static_cast<float>(v[k]);
    return out;
}
inline bool is_face(GLenum face) { return face == GL_FRONT || face == GL_BACK || face == GL_FRONT_AND_BACK; }
/// Whether `face` names face i: 0 front, 1 back.
inline bool names_face(GLenum face, unsigned i) {
    return face == GL_FRONT_AND_BACK || face == (i == 0 ? GLenum{GL_FRONT} : GLenum{GL_BACK});
}

}  // namespace wall::client
