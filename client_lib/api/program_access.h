// SPDX-License-Identifier: MIT
// Finding the shaders and programs that an API function is given, with the errors that OpenGL has for names that are
// none, and giving out text. Application threads; the share group's mutex is taken.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>

#include "client_lib/context/context.h"
#include "client_lib/objects/program.h"

namespace wall::client::api {

/// Of either kind; null: none.
std::shared_ptr<GlslObject> find_glsl_object(Context& c, GLuint name);
/// Null, and an error.
std::shared_ptr<Shader> shader_of(Context& c, GLuint name);
std::shared_ptr<Program> program_of(Context& c, GLuint name);
/// The same, once it is known how its linking went.
std::shared_ptr<Program> linked_program(Context& c, GLuint name);
/// What is active in the program as linked last; null if that failed. The share group's mutex is held.
inline const Executable* active(const Program& program) { return program.linked ? program.executable.get() : nullptr; }

/// Of the items' names, with its terminating zero; 0: there are no items.
template <class Items, class NameOf>
GLint longest_name(const Items& items, NameOf&& name_of) {
    std::size_t longest = 0;
    for (const auto& item : items) longest = std::max(longest, name_of(item).size() + 1);
    return static_cast<GLint>(longest);
}

/// Text and its length, as the Get...InfoLog, Get...Source and Get...Name commands give them.
void give_text(Context& c, const std::string& text, GLsizei room, GLsizei* length, GLchar* out);

}  // namespace wall::client::api
