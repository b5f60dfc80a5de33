// SPDX-License-Identifier: MIT
// glGetProgramInterfaceiv and glGetProgramResource* (OpenGL 4.4, 7.3.1; GL_ARB_program_interface_query): answered from
// what a node told after linking.
#include "client_lib/objects/program_interfaces.h"

#include <algorithm>
#include <iterator>
#include <span>

#include "client_lib/api/program_access.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

/// Null, and an error: no such interface.
const ProgramInterface* interface_of(Context& c, GLenum name) {
    const ProgramInterface* interface = find_program_interface(name);
    if (!interface) c.error(GL_INVALID_ENUM);
    return interface;
}

/// Calls use(executable) with the share group's mutex held; null: nothing is active in the program.
template <class Use>
void with_executable(Context& c, GLuint name, Use&& use) {
    const auto program = linked_program(c, name);
    if (!program) return;
    std::lock_guard lock(c.share().mutex);
    use(active(*program));
}

std::size_t count_of(const ProgramInterface& interface, const Executable* executable) {
    return executable ? interface.count(*executable) : 0;
}

/// The same with one of an interface, or an error.
template <class Use>
void with_resource(Context& c, GLuint name, const ProgramInterface& interface, GLuint index, Use&& use) {
    with_executable(c, name, [&](const Executable* executable) {
        if (index >= count_of(interface, executable)) return c.error(GL_INVALID_VALUE);
        use(*executable);
    });
}

/// The greatest value of length(index).
template <class Length>
GLint greatest(std::size_t count, Length&& length) {
    std::size_t most = 0;
    for (std::size_t i = 0; i < count; ++i) most = std::max(most, length(i));
    return static_cast<GLint>(most);
}

/// Values, as many as there is room for.
class Answer {
public:
    explicit Answer(std::span<GLint> room) : room_(room) {}
    void put(GLint value) {
        if (written_ < room_.size()) room_[written_++] = value;
    }
    GLsizei written() const { return static_cast<GLsizei>(written_); }

private:
    std::span<GLint> room_;
    std::size_t written_ = 0;
};

/// False: resources of the interface have no such value.
bool answer(const ProgramInterface& interface, const Resource& resource, std::size_t name_length, GLenum word,
            Answer& to) {
    if (word == GL_NAME_LENGTH && interface.name_of) return to.put(static_cast<GLint>(name_length)), true;
    if (interface.list_word != 0 && word == interface.length_word)
        return to.put(static_cast<GLint>(resource.list.size())), true;
    if (interface.list_word != 0 && word == interface.list_word) {
        for (const GLint each : resource.list) to.put(each);
        return true;
    }
    const auto found = std::ranges::find(resource.values, word, &Resource::Value::word);
    if (found == resource.values.end()) return false;
    return to.put(found->value), true;
}

/// The shader stage of an interface of variables that name functions; 0: it is another one.
GLenum stage_of_subroutine_uniforms(GLenum interface) {
    switch (interface) {
        case GL_VERTEX_SUBROUTINE_UNIFORM: return GL_VERTEX_SHADER;
        case GL_TESS_CONTROL_SUBROUTINE_UNIFORM: return GL_TESS_CONTROL_SHADER;
        case GL_TESS_EVALUATION_SUBROUTINE_UNIFORM: return GL_TESS_EVALUATION_SHADER;
        case GL_GEOMETRY_SUBROUTINE_UNIFORM: return GL_GEOMETRY_SHADER;
        case GL_FRAGMENT_SUBROUTINE_UNIFORM: return GL_FRAGMENT_SHADER;
        case GL_COMPUTE_SUBROUTINE_UNIFORM: return GL_COMPUTE_SHADER;
        default: return 0;
    }
}

/// -1: none.
GLint location_of(const Executable& executable, GLenum interface, const GLchar* name) {
    if (interface == GL_UNIFORM) return executable.location_of(name);
    if (interface == GL_PROGRAM_INPUT) return executable.input_location_of(name);
    GLint element = 0;
    const glapi::ActiveOutput* output = executable.output_of(name, element);
    return output && output->location >= 0 ? output->location + element : -1;
}

}  // namespace

/// Of words that there are not the specification says GL_INVALID_ENUM (OpenGL 4.6, 7.3.1), and Mesa 22.3 this.
void GetProgramInterfaceiv(Context& c, GLuint name, GLenum interface_name, GLenum pname, GLint* params) {
    if (!program_of(c, name)) return;
    const ProgramInterface* interface = find_program_interface(interface_name);
    if (!interface || !params) return c.error(GL_INVALID_OPERATION);
    with_executable(c, name, [&](const Executable* executable) {
        const std::size_t count = count_of(*interface, executable);
        switch (pname) {
            case GL_ACTIVE_RESOURCES: *params = static_cast<GLint>(count); break;
            case GL_MAX_NAME_LENGTH:
                if (!interface->name_of) return c.error(GL_INVALID_OPERATION);
                *params = greatest(count, [&](std::size_t i) { return interface->name_of(*executable, i).size() + 1; });
                break;
            case GL_MAX_NUM_ACTIVE_VARIABLES:
            case GL_MAX_NUM_COMPATIBLE_SUBROUTINES:
                if (interface->most_word != pname) return c.error(GL_INVALID_OPERATION);
                *params =
                    greatest(count, [&](std::size_t i) { return interface->describe(*executable, i).list.size(); });
                break;
            default: c.error(GL_INVALID_OPERATION);
        }
    });
}

GLuint GetProgramResourceIndex(Context& c, GLuint name, GLenum interface_name, const GLchar* resource) {
    GLuint index = GL_INVALID_INDEX;
    if (!program_of(c, name)) return index;
    const ProgramInterface* interface = find_program_interface(interface_name);
    if (!interface || !interface->name_of) return c.error(GL_INVALID_ENUM), index;
    with_executable(c, name, [&](const Executable* executable) {
        if (executable && resource) index = resource_index(*interface, *executable, resource);
    });
    return index;
}

void GetProgramResourceName(Context& c, GLuint name, GLenum interface_name, GLuint index, GLsizei room, GLsizei* length,
                            GLchar* out) {
    if (!program_of(c, name)) return;
    const ProgramInterface* interface = find_program_interface(interface_name);
    if (!interface || !interface->name_of) return c.error(GL_INVALID_ENUM);
    with_resource(c, name, *interface, index, [&](const Executable& executable) {
        give_text(c, interface->name_of(executable, index), room, length, out);
    });
}

void GetProgramResourceiv(Context& c, GLuint name, GLenum interface_name, GLuint index, GLsizei count,
                          const GLenum* words, GLsizei room, GLsizei* length, GLint* params) {
    if (!program_of(c, name)) return;
    const ProgramInterface* interface = interface_of(c, interface_name);
    if (!interface) return;
    if (count <= 0 || room < 0) return c.error(GL_INVALID_VALUE);
    with_resource(c, name, *interface, index, [&](const Executable& executable) {
        const Resource resource = interface->describe(executable, index);
        const std::size_t name_length = interface->name_of ? interface->name_of(executable, index).size() + 1 : 0;
        Answer to({params, static_cast<std::size_t>(room)});
        for (GLsizei i = 0; i < count; ++i) {
            if (!is_resource_word(words[i])) return c.error(GL_INVALID_ENUM);
            if (!answer(*interface, resource, name_length, words[i], to)) return c.error(GL_INVALID_OPERATION);
        }
        if (length) *length = to.written();
    });
}

GLint GetProgramResourceLocation(Context& c, GLuint name, GLenum interface, const GLchar* resource) {
    if (!program_of(c, name) || !resource) return -1;
    if (const GLenum stage = stage_of_subroutine_uniforms(interface); stage != 0)
        return GetSubroutineUniformLocation(c, name, stage, resource);
    if (interface != GL_UNIFORM && interface != GL_PROGRAM_INPUT && interface != GL_PROGRAM_OUTPUT)
        return c.error(GL_INVALID_ENUM), -1;
    GLint location = -1;
    with_executable(c, name, [&](const Executable* executable) {
        if (!executable) return c.error(GL_INVALID_OPERATION);
        location = location_of(*executable, interface, resource);
    });
    return location;
}

GLint GetProgramResourceLocationIndex(Context& c, GLuint name, GLenum interface, const GLchar* resource) {
    if (!program_of(c, name)) return -1;
    if (interface != GL_PROGRAM_OUTPUT) return c.error(GL_INVALID_ENUM), -1;
    return GetFragDataIndex(c, name, resource);
}

}  // namespace wall::client::api
