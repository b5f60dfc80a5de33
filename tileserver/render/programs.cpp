// SPDX-License-Identifier: MIT
#include "tileserver/render/programs.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "tileserver/render/shader_patch.h"

namespace wall::tileserver {
namespace {

std::string_view text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_shader_type(GLenum type) { return type == GL_VERTEX_SHADER || type == GL_FRAGMENT_SHADER; }

/// What a Get*InfoLog function gives.
template <class GetLength, class GetLog>
std::string read_log(GetLength&& get_length, GetLog&& get_log) {
    GLint length = 0;
    get_length(&length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    GLsizei written = 0;
    get_log(static_cast<GLsizei>(log.size()), &written, log.data());
    log.resize(static_cast<std::size_t>(std::max(written, 0)));
    return log;
}

void set_matrix(const Gl& gl, GLuint program, GLint location, GLsizei count, const glapi::UniformType& type,
                const GLfloat* v) {
    using Call = decltype(gl.ProgramUniformMatrix2fv);
    const Call calls[3][3] = {
        {gl.ProgramUniformMatrix2fv, gl.ProgramUniformMatrix2x3fv, gl.ProgramUniformMatrix2x4fv},
        {gl.ProgramUniformMatrix3x2fv, gl.ProgramUniformMatrix3fv, gl.ProgramUniformMatrix3x4fv},
        {gl.ProgramUniformMatrix4x2fv, gl.ProgramUniformMatrix4x3fv, gl.ProgramUniformMatrix4fv},
    };
    calls[type.columns - 2][type.rows - 2](program, location, count, GL_FALSE, v);
}

void set_vector(const Gl& gl, GLuint program, GLint location, GLsizei count, const glapi::UniformType& type,
                const std::byte* values) {
    const auto call = [&](const auto(&calls)[4], auto* v) { calls[type.rows - 1](program, location, count, v); };
    if (type.base == glapi::UniformBase::real) {
        const decltype(gl.ProgramUniform1fv) calls[] = {gl.ProgramUniform1fv, gl.ProgramUniform2fv,
                                                        gl.ProgramUniform3fv, gl.ProgramUniform4fv};
        call(calls, reinterpret_cast<const GLfloat*>(values));
    } else if (type.base == glapi::UniformBase::unsigned_integer) {
        const decltype(gl.ProgramUniform1uiv) calls[] = {gl.ProgramUniform1uiv, gl.ProgramUniform2uiv,
                                                         gl.ProgramUniform3uiv, gl.ProgramUniform4uiv};
        call(calls, reinterpret_cast<const GLuint*>(values));
    } else {
        const decltype(gl.ProgramUniform1iv) calls[] = {gl.ProgramUniform1iv, gl.ProgramUniform2iv,
                                                        gl.ProgramUniform3iv, gl.ProgramUniform4iv};
        call(calls, reinterpret_cast<const GLint*>(values));
    }
}

/// From the layer's pixels to the window's: scale, then offset.
std::array<float, 4> window_of(const LayerGeometry& g, bool upper_left) {
    if (g.window_width == 0 || g.window_height == 0) return {1, 1, 0, 0};
    const std::int32_t y = upper_left ? g.area.y - g.surface.y : g.offset_y();
    if (!g.scaled()) return {1, 1, static_cast<float>(g.offset_x()), static_cast<float>(y)};
    const double sx = 1 / g.scale_x(), sy = 1 / g.scale_y();
    return {static_cast<float>(sx), static_cast<float>(sy), static_cast<float>(g.offset_x() * sx),
            static_cast<float>(y * sy)};
}

}  // namespace

Programs::~Programs() {
    for (auto& [name, program] : programs_) release(program);
}

void Programs::release(Program& program) {
    if (program.driver == 0) return;
    driver_.forget_program(program.driver);
    gl_.DeleteProgram(program.driver);
}

Result<std::vector<std::byte>> Programs::compile(GLenum type, std::span<const std::byte> source) {
    if (!is_shader_type(type)) return fail("no such kind of shader");
    const GLuint shader = gl_.CreateShader(type);
    const GLchar* string = text(source).data();
    const auto length = static_cast<GLint>(source.size());
    gl_.ShaderSource(shader, 1, &string, &length);
    gl_.CompileShader(shader);
    GLint compiled = 0;
    gl_.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    glapi::CompileResult result{
        compiled != 0, read_log([&](GLint* n) { gl_.GetShaderiv(shader, GL_INFO_LOG_LENGTH, n); },
                                [&](GLsizei n, GLsizei* w, GLchar* to) { gl_.GetShaderInfoLog(shader, n, w, to); })};
    gl_.DeleteShader(shader);
    return encode(result);
}

GLuint Programs::build_shader(const glapi::ShaderSource& shader, bool& upper_left) {
    const GLuint made = gl_.CreateShader(shader.type);
    if (!shader.compiled) return made;
    const PatchedShader patched =
        shader.type == GL_FRAGMENT_SHADER ? patch_fragment_shader(shader.source) : PatchedShader{shader.source};
    upper_left |= patched.upper_left;
    const GLchar* string = patched.source.data();
    const auto length = static_cast<GLint>(patched.source.size());
    gl_.ShaderSource(made, 1, &string, &length);
    gl_.CompileShader(made);
    return made;
}

Programs::Built Programs::build(const glapi::ProgramDefinition& definition) {
    Built built{gl_.CreateProgram()};
    std::vector<GLuint> shaders;
    for (const auto& shader : definition.shaders) {
        shaders.push_back(build_shader(shader, built.upper_left));
        gl_.AttachShader(built.program, shaders.back());
    }
    for (const auto& attribute : definition.attributes)
        gl_.BindAttribLocation(built.program, attribute.index, attribute.name.c_str());
    gl_.LinkProgram(built.program);
    for (const GLuint shader : shaders) {
        gl_.DetachShader(built.program, shader);
        gl_.DeleteShader(shader);
    }
    return built;
}

Result<std::vector<std::byte>> Programs::link(ClientName name, std::span<const std::byte> bytes,
                                              bool wants_reflection) {
    const auto definition = glapi::decode_definition(bytes);
    if (!definition) return fail("bad program definition");
    for (const auto& shader : definition->shaders)
        if (!is_shader_type(shader.type)) return fail("no such kind of shader");
    std::size_t locations = 0;
    for (const auto& uniform : definition->uniforms)
        if ((locations += uniform.size) > kMaxProgramLocations) return fail("too many uniforms");
    if (!name || (programs_.size() >= kMaxPrograms && !programs_.contains(name))) return fail("too many programs");

    const Built built = build(*definition);
    GLint linked = 0;
    gl_.GetProgramiv(built.program, GL_LINK_STATUS, &linked);
    glapi::ProgramReflection reflection;
    if (wants_reflection || definition->uniforms.empty()) reflection = reflect(built.program);
    if (linked == 0) {
        gl_.DeleteProgram(built.program);
        return encode(reflection);
    }
    std::vector<glapi::UniformName> names = definition->uniforms;
    if (names.empty())
        for (const auto& uniform : reflection.uniforms)
            if (!uniform.built_in) names.push_back({uniform.size, uniform.name});
    Program& program = programs_[name];
    release(program);
    program = {built.program,
               map_locations(built.program, names),
               gl_.GetUniformLocation(built.program, kWindowUniform),
               built.upper_left,
               {}};
    return encode(reflection);
}

void Programs::erase(ClientName name) {
    const auto at = programs_.find(name);
    if (at == programs_.end()) return;
    release(at->second);
    programs_.erase(at);
}

// ---- what is active ----

GLint Programs::element_location(GLuint program, const std::string& name, std::uint32_t element) const {
    if (element == 0) return gl_.GetUniformLocation(program, name.c_str());
    return gl_.GetUniformLocation(program, (name + "[" + std::to_string(element) + "]").c_str());
}

std::vector<GLint> Programs::map_locations(GLuint program, const std::vector<glapi::UniformName>& names) const {
    std::vector<GLint> out;
    for (const auto& uniform : names)
        for (std::uint32_t i = 0; i < uniform.size; ++i) out.push_back(element_location(program, uniform.name, i));
    return out;
}

glapi::ProgramReflection Programs::reflect(GLuint program) const {
    glapi::ProgramReflection out;
    GLint linked = 0;
    gl_.GetProgramiv(program, GL_LINK_STATUS, &linked);
    out.linked = linked != 0;
    out.log = read_log([&](GLint* n) { gl_.GetProgramiv(program, GL_INFO_LOG_LENGTH, n); },
                       [&](GLsizei n, GLsizei* w, GLchar* to) { gl_.GetProgramInfoLog(program, n, w, to); });
    if (!out.linked) return out;
    read_uniforms(program, out);
    read_attributes(program, out);
    return out;
}

void Programs::read_uniforms(GLuint program, glapi::ProgramReflection& out) const {
    GLint count = 0, longest = 0;
    gl_.GetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
    gl_.GetProgramiv(program, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
    for (GLint i = 0; i < count; ++i) {
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        gl_.GetActiveUniform(program, static_cast<GLuint>(i), static_cast<GLsizei>(name.size()), &length, &size, &type,
                             name.data());
        glapi::ActiveUniform uniform{
            type, static_cast<std::uint32_t>(size), false, false, name.substr(0, static_cast<std::size_t>(length)), {}};
        if (uniform.name == kWindowUniform) continue;
        if (uniform.name.ends_with("[0]")) {
            uniform.array = true;
            uniform.name.resize(uniform.name.size() - 3);
        }
        uniform.array |= size > 1;
        uniform.built_in = uniform.name.starts_with("gl_");
        if (!uniform.built_in) {
            if (gl_.GetUniformLocation(program, uniform.name.c_str()) < 0) continue;  // in a block
            read_initial(program, uniform);
        }
        out.uniforms.push_back(std::move(uniform));
    }
}

void Programs::read_initial(GLuint program, glapi::ActiveUniform& uniform) const {
    const auto* type = glapi::find_uniform_type(uniform.type);
    if (type == nullptr) return;
    std::array<std::uint32_t, 16> words;
    for (std::uint32_t i = 0; i < uniform.size; ++i) {
        words.fill(0);
        const GLint location = element_location(program, uniform.name, i);
        if (location >= 0) {
            if (type->base == glapi::UniformBase::real)
                gl_.GetUniformfv(program, location, reinterpret_cast<GLfloat*>(words.data()));
            else gl_.GetUniformiv(program, location, reinterpret_cast<GLint*>(words.data()));
        }
        uniform.initial.insert(uniform.initial.end(), words.begin(), words.begin() + type->words());
    }
}

void Programs::read_attributes(GLuint program, glapi::ProgramReflection& out) const {
    GLint count = 0, longest = 0;
    gl_.GetProgramiv(program, GL_ACTIVE_ATTRIBUTES, &count);
    gl_.GetProgramiv(program, GL_ACTIVE_ATTRIBUTE_MAX_LENGTH, &longest);
    std::string name(static_cast<std::size_t>(std::max(longest, 1)), '\0');
    for (GLint i = 0; i < count; ++i) {
        GLsizei length = 0;
        GLint size = 0;
        GLenum type = 0;
        gl_.GetActiveAttrib(program, static_cast<GLuint>(i), static_cast<GLsizei>(name.size()), &length, &size, &type,
                            name.data());
        glapi::ActiveAttribute attribute{type, static_cast<std::uint32_t>(size), -1,
                                         name.substr(0, static_cast<std::size_t>(length))};
        attribute.location = gl_.GetAttribLocation(program, attribute.name.c_str());
        out.attributes.push_back(std::move(attribute));
    }
}

// ---- drawing ----

Result<void> Programs::set_uniform(ClientName name, std::uint32_t location, GLenum type_name, std::uint32_t count,
                                   std::span<const std::byte> values) {
    const auto at = programs_.find(name);
    if (at == programs_.end()) return fail("no such program");
    const auto* type = glapi::find_uniform_type(type_name);
    const Program& program = at->second;
    if (type == nullptr) return fail("no such type");
    if (count == 0 || location >= program.locations.size() || count > program.locations.size() - location)
        return fail("no such location");
    if (values.size() != std::size_t{count} * type->words() * 4) return fail("size does not fit the values");
    const GLint here = program.locations[location];
    if (here < 0) return {};
    if (type->matrix())
        set_matrix(gl_, program.driver, here, static_cast<GLsizei>(count), *type,
                   reinterpret_cast<const GLfloat*>(values.data()));
    else set_vector(gl_, program.driver, here, static_cast<GLsizei>(count), *type, values.data());
    return {};
}

void Programs::use_named(ClientName name, const LayerGeometry& layer) {
    const auto at = programs_.find(name);
    if (at == programs_.end()) return driver_.use_program(0);
    Program& program = at->second;
    driver_.use_program(program.driver);
    if (program.window < 0) return;
    const auto value = window_of(layer, program.upper_left);
    if (std::exchange(program.window_value, value) != value)
        gl_.ProgramUniform4fv(program.driver, program.window, 1, value.data());
}

}  // namespace wall::tileserver
