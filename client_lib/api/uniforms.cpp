// SPDX-License-Identifier: MIT
// Values of uniforms (OpenGL 2.1, 2.15.3): kept in the program, sent when something is drawn with it. Setting an equal
// value is no change.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "client_lib/api/program_access.h"
#include "client_lib/api/uniform_values.h"
#include "client_lib/context/param_commands.h"
#include "client_lib/context/program_use.h"
#include "client_lib/objects/program_pipeline.h"

namespace wall::client::api {
namespace {

using glapi::UniformBase;
using glapi::UniformType;

bool accepts(const UniformType& type, const Given& given) {
    if (type.columns != given.columns || type.rows != given.rows) return false;
    if (type.base == UniformBase::boolean) return given.base != UniformBase::double_real;
    if (type.base == UniformBase::sampler || type.base == UniformBase::image) return given.base == UniformBase::integer;
    return type.base == given.base;
}

/// A boolean is 0 or 1 in the shadow; of a float, -0 is false as well.
std::vector<std::uint32_t> as_booleans(const Given& given, std::size_t words) {
    std::vector<std::uint32_t> out(given.words.begin(), given.words.begin() + static_cast<std::ptrdiff_t>(words));
    for (std::uint32_t& word : out) word = (given.base == UniformBase::real ? word << 1 : word) != 0;
    return out;
}

bool names_units(std::span<const std::uint32_t> words, std::uint32_t units) {
    return std::all_of(words.begin(), words.end(), [=](std::uint32_t unit) { return unit < units; });
}

/// The error to raise, or none. Geometry that is still packed is sent with the values it was drawn with.
GLenum store(Context& c, Program& program, GLint location, GLsizei count, const Given& given) {
    std::unique_lock lock(c.share().mutex);
    Executable& executable = *program.executable;
    const UniformPlace* place = executable.place_of(location);
    if (!place) return executable.ignores(location) ? GL_NO_ERROR : GL_INVALID_OPERATION;
    Uniform& uniform = executable.uniforms[place->uniform];
    if ((count > 1 && !uniform.array) || !accepts(*uniform.type, given)) return GL_INVALID_OPERATION;
    const std::size_t elements =
        std::min(static_cast<std::size_t>(count), static_cast<std::size_t>(uniform.size) - place->element);
    if (given.words.size() < elements * given.words_each()) return GL_NO_ERROR;  // a null pointer
    std::span<const std::uint32_t> words = given.words.first(elements * given.words_each());
    std::vector<std::uint32_t> booleans;
    if (uniform.type->base == UniformBase::boolean) words = booleans = as_booleans(given, words.size());
    if (uniform.type->base == UniformBase::sampler && !names_units(words, kTextureImageUnits)) return GL_INVALID_VALUE;
    if (uniform.type->base == UniformBase::image && !names_units(words, glstate::el::image_unit::count))
        return GL_INVALID_VALUE;
    if (executable.holds(uniform, place->element, words)) return GL_NO_ERROR;
    if (!c.packer.empty()) {
        lock.unlock();
        c.flush_block();
        return store(c, program, location, count, given);
    }
    executable.store(uniform, place->element, words);
    c.share().last_change = executable.last_change;
    return GL_NO_ERROR;
}

/// The nearest that there is (OpenGL 4.5, 2.2.2).
template <class Real>
GLuint rounded_unsigned(Real value) {
    constexpr auto kBehind = static_cast<Real>(4294967296.0);
    if (!(value > 0)) return 0;
    return value >= kBehind ? ~GLuint{0} : static_cast<GLuint>(std::round(value));
}

template <class Out, class Real>
Out converted_real(const std::uint32_t* words) {
    Real value;
    std::memcpy(&value, words, sizeof value);
    if constexpr (std::is_same_v<Out, GLint>) return rounded_param(static_cast<GLfloat>(value));
    else if constexpr (std::is_same_v<Out, GLuint>) return rounded_unsigned(value);
    else return static_cast<Out>(value);
}

/// The component that begins there.
template <class Out>
Out converted(UniformBase base, const std::uint32_t* words) {
    if (base == UniformBase::real) return converted_real<Out, GLfloat>(words);
    if (base == UniformBase::double_real) return converted_real<Out, GLdouble>(words);
    const std::uint32_t word = *words;
    if (base == UniformBase::unsigned_integer) return static_cast<Out>(word);
    if constexpr (std::is_same_v<Out, GLuint>) return static_cast<GLuint>(std::max(static_cast<GLint>(word), 0));
    return static_cast<Out>(static_cast<GLint>(word));
}

/// `room`: bytes that there are for it; nothing: the program did not say.
template <class Out>
void get(Context& c, GLuint name, GLint location, Out* out, std::optional<GLsizei> room = std::nullopt) {
    std::shared_ptr<GlslObject> object;
    {
        std::lock_guard lock(c.share().mutex);
        object = c.share().glsl_objects.find(name);
    }
    if (!object) return c.error(GL_INVALID_VALUE);
    if (object->kind != GlslObject::Kind::program) return c.error(GL_INVALID_OPERATION);
    auto& program = static_cast<Program&>(*object);
    learn_link_result(c, program);
    std::lock_guard lock(c.share().mutex);
    const UniformPlace* place = program.linked ? program.executable->place_of(location) : nullptr;
    if (!place) return c.error(GL_INVALID_OPERATION);
    const Uniform& uniform = program.executable->uniforms[place->uniform];
    const unsigned words = uniform.type->words(), each = words / uniform.type->components();
    const auto element = program.executable->words_of(uniform).subspan(std::size_t{place->element} * words, words);
    if (room && (*room < 0 || static_cast<std::size_t>(*room) < words / each * sizeof(Out)))
        return c.error(GL_INVALID_OPERATION);
    for (unsigned i = 0; i < words; i += each) *out++ = converted<Out>(uniform.type->base, &element[i]);
}

}  // namespace

std::shared_ptr<Program> uniform_target(Context& c) {
    const bool of_pipeline = c.program && c.program == c.pipelines->bound;
    auto program = of_pipeline ? c.pipelines->bound->active : c.program;
    if (!program) c.error(GL_INVALID_OPERATION);
    return program;
}

std::shared_ptr<Program> uniform_target(Context& c, GLuint name) {
    auto program = linked_program(c, name);
    if (!program || program->linked) return program;
    return c.error(GL_INVALID_OPERATION), nullptr;
}

void set_uniform(Context& c, const std::shared_ptr<Program>& program, GLint location, GLsizei count,
                 const Given& given) {
    if (!program) return;
    if (count < 0) return c.error(GL_INVALID_VALUE);
    if (location == -1) return;
    if (const GLenum error = store(c, *program, location, count, given); error != GL_NO_ERROR) c.error(error);
}

void Uniform1f(Context& c, GLint location, GLfloat x) { set_one(c, uniform_target(c), location, x); }
void Uniform2f(Context& c, GLint location, GLfloat x, GLfloat y) { set_one(c, uniform_target(c), location, x, y); }
void Uniform3f(Context& c, GLint location, GLfloat x, GLfloat y, GLfloat z) {
    set_one(c, uniform_target(c), location, x, y, z);
}
void Uniform4f(Context& c, GLint location, GLfloat x, GLfloat y, GLfloat z, GLfloat w) {
    set_one(c, uniform_target(c), location, x, y, z, w);
}
void Uniform1i(Context& c, GLint location, GLint x) { set_one(c, uniform_target(c), location, x); }
void Uniform2i(Context& c, GLint location, GLint x, GLint y) { set_one(c, uniform_target(c), location, x, y); }
void Uniform3i(Context& c, GLint location, GLint x, GLint y, GLint z) {
    set_one(c, uniform_target(c), location, x, y, z);
}
void Uniform4i(Context& c, GLint location, GLint x, GLint y, GLint z, GLint w) {
    set_one(c, uniform_target(c), location, x, y, z, w);
}

void Uniform1fv(Context& c, GLint location, GLsizei count, const GLfloat* v) {
    set_vectors<1>(c, uniform_target(c), location, count, v);
}
void Uniform2fv(Context& c, GLint location, GLsizei count, const GLfloat* v) {
    set_vectors<2>(c, uniform_target(c), location, count, v);
}
void Uniform3fv(Context& c, GLint location, GLsizei count, const GLfloat* v) {
    set_vectors<3>(c, uniform_target(c), location, count, v);
}
void Uniform4fv(Context& c, GLint location, GLsizei count, const GLfloat* v) {
    set_vectors<4>(c, uniform_target(c), location, count, v);
}
void Uniform1iv(Context& c, GLint location, GLsizei count, const GLint* v) {
    set_vectors<1>(c, uniform_target(c), location, count, v);
}
void Uniform2iv(Context& c, GLint location, GLsizei count, const GLint* v) {
    set_vectors<2>(c, uniform_target(c), location, count, v);
}
void Uniform3iv(Context& c, GLint location, GLsizei count, const GLint* v) {
    set_vectors<3>(c, uniform_target(c), location, count, v);
}
void Uniform4iv(Context& c, GLint location, GLsizei count, const GLint* v) {
    set_vectors<4>(c, uniform_target(c), location, count, v);
}

void Uniform1ui(Context& c, GLint location, GLuint x) { set_one(c, uniform_target(c), location, x); }
void Uniform2ui(Context& c, GLint location, GLuint x, GLuint y) { set_one(c, uniform_target(c), location, x, y); }
void Uniform3ui(Context& c, GLint location, GLuint x, GLuint y, GLuint z) {
    set_one(c, uniform_target(c), location, x, y, z);
}
void Uniform4ui(Context& c, GLint location, GLuint x, GLuint y, GLuint z, GLuint w) {
    set_one(c, uniform_target(c), location, x, y, z, w);
}
void Uniform1uiv(Context& c, GLint location, GLsizei count, const GLuint* v) {
    set_vectors<1>(c, uniform_target(c), location, count, v);
}
void Uniform2uiv(Context& c, GLint location, GLsizei count, const GLuint* v) {
    set_vectors<2>(c, uniform_target(c), location, count, v);
}
void Uniform3uiv(Context& c, GLint location, GLsizei count, const GLuint* v) {
    set_vectors<3>(c, uniform_target(c), location, count, v);
}
void Uniform4uiv(Context& c, GLint location, GLsizei count, const GLuint* v) {
    set_vectors<4>(c, uniform_target(c), location, count, v);
}

void UniformMatrix2fv(Context& c, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<2, 2>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix3fv(Context& c, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<3, 3>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix4fv(Context& c, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<4, 4>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix2x3fv(Context& c, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<2, 3>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix3x2fv(Context& c, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<3, 2>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix2x4fv(Context& c, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<2, 4>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix4x2fv(Context& c, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<4, 2>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix3x4fv(Context& c, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<3, 4>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix4x3fv(Context& c, GLint l, GLsizei n, GLboolean t, const GLfloat* v) {
    set_matrices<4, 3>(c, uniform_target(c), l, n, t, v);
}

void Uniform1d(Context& c, GLint location, GLdouble x) { set_one(c, uniform_target(c), location, x); }
void Uniform2d(Context& c, GLint location, GLdouble x, GLdouble y) { set_one(c, uniform_target(c), location, x, y); }
void Uniform3d(Context& c, GLint location, GLdouble x, GLdouble y, GLdouble z) {
    set_one(c, uniform_target(c), location, x, y, z);
}
void Uniform4d(Context& c, GLint location, GLdouble x, GLdouble y, GLdouble z, GLdouble w) {
    set_one(c, uniform_target(c), location, x, y, z, w);
}
void Uniform1dv(Context& c, GLint location, GLsizei count, const GLdouble* v) {
    set_vectors<1>(c, uniform_target(c), location, count, v);
}
void Uniform2dv(Context& c, GLint location, GLsizei count, const GLdouble* v) {
    set_vectors<2>(c, uniform_target(c), location, count, v);
}
void Uniform3dv(Context& c, GLint location, GLsizei count, const GLdouble* v) {
    set_vectors<3>(c, uniform_target(c), location, count, v);
}
void Uniform4dv(Context& c, GLint location, GLsizei count, const GLdouble* v) {
    set_vectors<4>(c, uniform_target(c), location, count, v);
}

void UniformMatrix2dv(Context& c, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<2, 2>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix3dv(Context& c, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<3, 3>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix4dv(Context& c, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<4, 4>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix2x3dv(Context& c, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<2, 3>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix3x2dv(Context& c, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<3, 2>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix2x4dv(Context& c, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<2, 4>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix4x2dv(Context& c, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<4, 2>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix3x4dv(Context& c, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<3, 4>(c, uniform_target(c), l, n, t, v);
}
void UniformMatrix4x3dv(Context& c, GLint l, GLsizei n, GLboolean t, const GLdouble* v) {
    set_matrices<4, 3>(c, uniform_target(c), l, n, t, v);
}

void GetUniformfv(Context& c, GLuint program, GLint location, GLfloat* params) { get(c, program, location, params); }
void GetUniformuiv(Context& c, GLuint program, GLint location, GLuint* params) { get(c, program, location, params); }
void GetUniformiv(Context& c, GLuint program, GLint location, GLint* params) { get(c, program, location, params); }
void GetUniformdv(Context& c, GLuint program, GLint location, GLdouble* params) { get(c, program, location, params); }

void GetnUniformfv(Context& c, GLuint program, GLint location, GLsizei room, GLfloat* params) {
    get(c, program, location, params, room);
}
void GetnUniformiv(Context& c, GLuint program, GLint location, GLsizei room, GLint* params) {
    get(c, program, location, params, room);
}
void GetnUniformuiv(Context& c, GLuint program, GLint location, GLsizei room, GLuint* params) {
    get(c, program, location, params, room);
}
void GetnUniformdv(Context& c, GLuint program, GLint location, GLsizei room, GLdouble* params) {
    get(c, program, location, params, room);
}

}  // namespace wall::client::api
