// SPDX-License-Identifier: MIT
// Display list commands (OpenGL 1.2.1, 5.4).
#include "client_lib/context/lists.h"

#include <algorithm>
#include <cstring>

#include "client_lib/context/param_commands.h"
#include "client_lib/objects/share_group.h"

namespace wall::client::api {
namespace {

std::shared_ptr<DisplayList> find_list(Context& c, GLuint name) {
    std::lock_guard lock(c.share().mutex);
    return c.share().lists.find(name);
}

void call_list(Context& c, GLuint name) {
    const auto list = find_list(c, name);
    if (!list || c.lists->depth >= kListNestingLimit) return;
    struct Deeper {
        unsigned& depth;
        explicit Deeper(unsigned& d) : depth(d) { ++depth; }
        ~Deeper() { --depth; }
    } const deeper(c.lists->depth);
    execute_list(c, *list);
}

template <class T>
GLint element(const void* names, GLsizei i) {
    T value;
    std::memcpy(&value, static_cast<const std::byte*>(names) + static_cast<std::size_t>(i) * sizeof value,
                sizeof value);
    return to_int(value);
}

/// Big-endian groups of bytes.
template <std::size_t N>
GLint group(const void* names, GLsizei i) {
    const auto* at = static_cast<const GLubyte*>(names) + static_cast<std::size_t>(i) * N;
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < N; ++k) value = value << 8 | at[k];
    return static_cast<GLint>(value);
}

struct NameType {
    GLenum type;
    GLint (*read)(const void* names, GLsizei i);
};
constexpr NameType kNameTypes[] = {
    {GL_BYTE, element<GLbyte>},   {GL_UNSIGNED_BYTE, element<GLubyte>},
    {GL_SHORT, element<GLshort>}, {GL_UNSIGNED_SHORT, element<GLushort>},
    {GL_INT, element<GLint>},     {GL_UNSIGNED_INT, element<GLuint>},
    {GL_FLOAT, element<GLfloat>}, {GL_2_BYTES, group<2>},
    {GL_3_BYTES, group<3>},       {GL_4_BYTES, group<4>},
};

/// Null and an error if the arguments are wrong.
const NameType* name_type(Context& c, GLsizei n, GLenum type) {
    for (const NameType& row : kNameTypes)
        if (row.type == type) return n < 0 ? c.error(GL_INVALID_VALUE), nullptr : &row;
    c.error(GL_INVALID_ENUM);
    return nullptr;
}

void finish_compiling(Context& c) {
    c.lists->name = 0;
    c.lists->mode = 0;
    c.lists->recorder.execute = false;
    c.lists->recorder.clear();
    c.table = &tables::immediate;
    c.packer.set_closed(false);
}

}  // namespace

void NewList(Context& c, GLuint list, GLenum mode) {
    if (list == 0) return c.error(GL_INVALID_VALUE);
    if (mode != GL_COMPILE && mode != GL_COMPILE_AND_EXECUTE) return c.error(GL_INVALID_ENUM);
    if (c.lists->name != 0) return c.error(GL_INVALID_OPERATION);
    c.lists->name = list;
    c.lists->mode = mode;
    c.lists->recorder.execute = mode == GL_COMPILE_AND_EXECUTE;
    c.table = &tables::compile;
    c.packer.set_closed(true);
}

void EndList(Context& c) {
    if (c.lists->name == 0) return c.error(GL_INVALID_OPERATION);
    const GLuint name = c.lists->name;
    const std::vector<std::byte> recording = c.lists->recorder.take();
    finish_compiling(c);
    auto compiled = compile_list(c, recording);
    std::lock_guard lock(c.share().mutex);
    c.share().lists.put(name, std::move(compiled));
}

void CallList(Context& c, GLuint list) { call_list(c, list); }

void CallLists(Context& c, GLsizei n, GLenum type, const void* lists) {
    const NameType* row = name_type(c, n, type);
    if (!row) return;
    for (GLsizei i = 0; i < n; ++i) call_list(c, c.state.local.list_base + static_cast<GLuint>(row->read(lists, i)));
}

void ListBase(Context& c, GLuint base) { c.set<glstate::el::list_base>(0, base); }

GLuint GenLists(Context& c, GLsizei range) {
    if (range < 0) return c.error(GL_INVALID_VALUE), 0;
    std::lock_guard lock(c.share().mutex);
    return c.share().lists.reserve(static_cast<GLuint>(range));
}

GLboolean IsList(Context& c, GLuint list) {
    std::lock_guard lock(c.share().mutex);
    return list != 0 && c.share().lists.known(list);
}

void DeleteLists(Context& c, GLuint list, GLsizei range) {
    if (range < 0) return c.error(GL_INVALID_VALUE);
    std::lock_guard lock(c.share().mutex);
    auto& lists = c.share().lists;
    const auto end =
        std::min<std::uint64_t>(std::uint64_t{list} + static_cast<GLuint>(range), std::uint64_t{lists.last()} + 1);
    for (std::uint64_t name = list; name < end; ++name) lists.erase(static_cast<GLuint>(name));
}

}  // namespace wall::client::api

namespace wall::client::compile {

// The base is added when the list is called.
void CallLists(Context& c, GLsizei n, GLenum type, const void* lists) {
    const api::NameType* row = api::name_type(c, n, type);
    if (!row) return;
    std::vector<GLint> offsets;
    for (GLsizei i = 0; i < n; ++i) offsets.push_back(row->read(lists, i));
    c.list().record(static_cast<std::uint16_t>(CommandId::CallLists), glapi::recorded_array(offsets.data(), n));
    if (c.list().execute) execution_table(c).CallLists(c, n, GL_INT, offsets.data());
}

}  // namespace wall::client::compile

namespace wall::client::replay {

void CallLists(Context& c, std::span<const std::byte> payload) {
    glapi::RecordReader in(payload);
    const auto count = glapi::RecordReader(payload).get<GLsizei>();
    api::CallLists(c, count, GL_INT, in.array<GLint>());
}

}  // namespace wall::client::replay
