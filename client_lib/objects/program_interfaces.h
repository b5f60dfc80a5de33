// SPDX-License-Identifier: MIT
// What may be asked of a linked program about its interfaces (OpenGL 4.4, 7.3.1; GL_ARB_program_interface_query): lists
// of resources, each with a name, values and perhaps a list of others. Pure; the share group's mutex is held.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "client_lib/objects/program.h"

namespace wall::client {

/// One of an interface.
struct Resource {
    struct Value {
        GLenum word;
        GLint value;
    };
    std::vector<Value> values;  ///< all that its interface has, but the length of its name and `list`
    std::vector<GLint> list;    ///< indices of its active variables, or of the functions that it may name
};

struct ProgramInterface {
    GLenum name;
    std::size_t (*count)(const Executable&);
    /// `index` is below count(), as for name_of.
    Resource (*describe)(const Executable&, std::size_t index);
    /// In full, with "[0]" of an array. Null: they have no names.
    std::string (*name_of)(const Executable&, std::size_t index);
    /// What asks for Resource::list, for its length, and for the greatest length of all; 0: there is no such list.
    GLenum list_word = 0, length_word = 0, most_word = 0;
    /// What glGetProgramResourceIndex answers, where that is not the place in the list (functions have numbers of their
    /// own); null: it is.
    GLuint (*number_of)(const Executable&, std::size_t index) = nullptr;
};

/// Null: no such interface.
const ProgramInterface* find_program_interface(GLenum name);

/// Whether it is the word of a value that resources of some interface have.
bool is_resource_word(GLenum word);

/// Of "name" or, of an array, "name[0]"; GL_INVALID_INDEX: there is none of that name, or they have no names.
GLuint resource_index(const ProgramInterface& interface, const Executable& executable, std::string_view name);

/// The variables of blocks whose names differ in indices only have the first one's index as their block: calls
/// use(index) for those of `block`.
template <class Variables, class Blocks, class Use>
void for_each_member(const Variables& variables, const Blocks& blocks, std::size_t block, Use&& use) {
    const auto array_of = [&](std::size_t index) {
        const std::string_view name = blocks[index].name;
        return name.substr(0, name.find('['));
    };
    for (std::size_t i = 0; i < variables.size(); ++i)
        if (variables[i].place.block >= 0 &&
            array_of(static_cast<std::size_t>(variables[i].place.block)) == array_of(block))
            use(static_cast<GLint>(i));
}

}  // namespace wall::client
