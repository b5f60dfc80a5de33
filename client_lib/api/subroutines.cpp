// SPDX-License-Identifier: MIT
// Subroutines (OpenGL 4.0, 2.11.5): which functions variables of a stage name. That is kept in the program, and begins
// anew when a context takes it into use; of contexts that draw with one program at the same time, one chooses for all.
#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "client_lib/api/program_access.h"
#include "client_lib/context/program_use.h"

namespace wall::client::api {
namespace {

bool is_stage(GLenum stage) { return std::ranges::find(glapi::kShaderStages, stage) != std::end(glapi::kShaderStages); }

/// Calls use(Subroutines) with what a stage of a program has, which may be nothing. False, and an error: no program, or
/// one that is not linked.
template <class Use>
bool with_stage(Context& c, GLuint name, GLenum stage, Use&& use) {
    if (!is_stage(stage)) return c.error(GL_INVALID_ENUM), false;
    const auto program = linked_program(c, name);
    if (!program) return false;
    std::lock_guard lock(c.share().mutex);
    if (!program->linked) return c.error(GL_INVALID_OPERATION), false;
    const Subroutines* found = program->executable->subroutines_of(stage);
    use(found ? *found : Subroutines());
    return true;
}

std::string full_name(const glapi::SubroutineUniform& uniform) {
    return uniform.array ? uniform.name + "[0]" : uniform.name;
}

/// "name", or "name[2]" of an array; nothing: the variable has no such element.
std::optional<GLint> location_of(const glapi::SubroutineUniform& uniform, std::string_view wanted) {
    if (wanted == uniform.name) return uniform.location;
    if (!uniform.array || !wanted.starts_with(uniform.name + "[") || !wanted.ends_with(']')) return std::nullopt;
    const std::string_view digits = wanted.substr(uniform.name.size() + 1, wanted.size() - uniform.name.size() - 2);
    std::uint32_t element = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), element);
    if (error != std::errc() || end != digits.data() + digits.size() || element >= uniform.size) return std::nullopt;
    return uniform.location + static_cast<GLint>(element);
}

/// The variable at a location; null: none.
const glapi::SubroutineUniform* at_location(const Subroutines& stage, std::size_t location) {
    const auto found = std::ranges::find_if(stage.uniforms, [&](const glapi::SubroutineUniform& uniform) {
        const auto first = static_cast<std::size_t>(uniform.location);
        return uniform.location >= 0 && location >= first && location - first < uniform.size;
    });
    return found == stage.uniforms.end() ? nullptr : &*found;
}

/// Of several that are drawn with together, the one that has the stage.
Executable& executable_of(const Program& program, GLenum stage) {
    const auto has = [&](const auto& part) { return part->executable->subroutines_of(stage) != nullptr; };
    const auto& parts = program.executable->parts;
    const auto found = std::ranges::find_if(parts, has);
    return found == parts.end() ? *program.executable : *(*found)->executable;
}

bool has_function(const Subroutines& stage, GLuint index) {
    if (stage.indices.empty()) return index < stage.functions.size();
    return std::ranges::find(stage.indices, index) != stage.indices.end();
}

/// The error of naming these functions; none: it may be done.
GLenum error_of(const Subroutines& stage, std::span<const GLuint> indices) {
    if (indices.size() != stage.locations) return GL_INVALID_VALUE;
    for (std::size_t i = 0; i < indices.size(); ++i) {
        const auto* uniform = at_location(stage, i);
        if (!uniform) continue;
        if (!has_function(stage, indices[i])) return GL_INVALID_VALUE;
        if (std::ranges::find(uniform->compatible, indices[i]) == uniform->compatible.end())
            return GL_INVALID_OPERATION;
    }
    return GL_NO_ERROR;
}

}  // namespace

void UniformSubroutinesuiv(Context& c, GLenum stage, GLsizei count, const GLuint* indices) {
    if (!is_stage(stage)) return c.error(GL_INVALID_ENUM);
    if (!c.program) return c.error(GL_INVALID_OPERATION);
    c.flush_block();
    GLenum error = GL_NO_ERROR;
    {
        std::lock_guard lock(c.share().mutex);
        Executable& executable = executable_of(*c.program, stage);
        Subroutines* found = executable.subroutines_of(stage);
        const std::span given(indices, static_cast<std::size_t>(std::max(count, 0)));
        error = count < 0 ? GLenum{GL_INVALID_VALUE} : error_of(found ? *found : Subroutines(), given);
        if (error == GL_NO_ERROR && found) {
            executable.choose(*found, given);
            c.share().last_change = executable.last_change;
        }
    }
    if (error != GL_NO_ERROR) c.error(error);
}

void GetUniformSubroutineuiv(Context& c, GLenum stage, GLint location, GLuint* params) {
    if (!is_stage(stage)) return c.error(GL_INVALID_ENUM);
    if (!c.program) return c.error(GL_INVALID_OPERATION);
    std::lock_guard lock(c.share().mutex);
    const Subroutines* found = executable_of(*c.program, stage).subroutines_of(stage);
    if (!found || location < 0 || static_cast<std::size_t>(location) >= found->chosen.size())
        return c.error(GL_INVALID_VALUE);
    *params = found->chosen[static_cast<std::size_t>(location)];
}

GLuint GetSubroutineIndex(Context& c, GLuint program, GLenum stage, const GLchar* name) {
    GLuint index = GL_INVALID_INDEX;
    with_stage(c, program, stage, [&](const Subroutines& found) {
        const auto at = std::ranges::find(found.functions, name);
        if (at != found.functions.end()) index = found.index_of(static_cast<std::size_t>(at - found.functions.begin()));
    });
    return index;
}

GLint GetSubroutineUniformLocation(Context& c, GLuint program, GLenum stage, const GLchar* name) {
    GLint location = -1;
    with_stage(c, program, stage, [&](const Subroutines& found) {
        for (const auto& uniform : found.uniforms)
            if (const auto here = location_of(uniform, name)) location = *here;
    });
    return location;
}

void GetActiveSubroutineUniformiv(Context& c, GLuint program, GLenum stage, GLuint index, GLenum pname, GLint* values) {
    with_stage(c, program, stage, [&](const Subroutines& found) {
        if (index >= found.uniforms.size()) return c.error(GL_INVALID_VALUE);
        const glapi::SubroutineUniform& uniform = found.uniforms[index];
        switch (pname) {
            case GL_NUM_COMPATIBLE_SUBROUTINES: *values = static_cast<GLint>(uniform.compatible.size()); break;
            case GL_COMPATIBLE_SUBROUTINES: std::ranges::copy(uniform.compatible, values); break;
            case GL_UNIFORM_SIZE: *values = static_cast<GLint>(uniform.size); break;
            case GL_UNIFORM_NAME_LENGTH: *values = static_cast<GLint>(full_name(uniform).size() + 1); break;
            default: c.error(GL_INVALID_ENUM);
        }
    });
}

void GetActiveSubroutineUniformName(Context& c, GLuint program, GLenum stage, GLuint index, GLsizei room,
                                    GLsizei* length, GLchar* name) {
    with_stage(c, program, stage, [&](const Subroutines& found) {
        if (index >= found.uniforms.size()) return c.error(GL_INVALID_VALUE);
        give_text(c, full_name(found.uniforms[index]), room, length, name);
    });
}

void GetActiveSubroutineName(Context& c, GLuint program, GLenum stage, GLuint index, GLsizei room, GLsizei* length,
                             GLchar* name) {
    with_stage(c, program, stage, [&](const Subroutines& found) {
        if (index >= found.functions.size()) return c.error(GL_INVALID_VALUE);
        give_text(c, found.functions[index], room, length, name);
    });
}

void GetProgramStageiv(Context& c, GLuint program, GLenum stage, GLenum pname, GLint* values) {
    with_stage(c, program, stage, [&](const Subroutines& found) {
        switch (pname) {
            case GL_ACTIVE_SUBROUTINES: *values = static_cast<GLint>(found.functions.size()); break;
            case GL_ACTIVE_SUBROUTINE_UNIFORMS: *values = static_cast<GLint>(found.uniforms.size()); break;
            case GL_ACTIVE_SUBROUTINE_UNIFORM_LOCATIONS: *values = static_cast<GLint>(found.locations); break;
            case GL_ACTIVE_SUBROUTINE_MAX_LENGTH:
                *values = longest_name(found.functions, [](const std::string& name) { return name; });
                break;
            case GL_ACTIVE_SUBROUTINE_UNIFORM_MAX_LENGTH: *values = longest_name(found.uniforms, full_name); break;
            default: c.error(GL_INVALID_ENUM);
        }
    });
}

}  // namespace wall::client::api
