// SPDX-License-Identifier: MIT
// glGetString, glGetStringi, glGetPointerv.
#include <map>
#include <mutex>

#include "client_lib/context.h"
#include "client_lib/select.h"
#include "client_lib/version.h"

namespace wall::client::api {
namespace {

/// Texts given to the application live as long as the process.
const GLubyte* kept(const std::string& text) {
    static auto* mutex = new std::mutex();
    static auto* texts = new std::map<std::string, int>();
    std::lock_guard lock(*mutex);
    return reinterpret_cast<const GLubyte*>(texts->try_emplace(text, 0).first->first.c_str());
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

const void* array_pointer(Context& c, GLenum pname, bool& known) {
    const auto& local = c.state.local;
    const struct {
        GLenum pname;
        std::uint64_t pointer;
    } rows[] = {
        {GL_VERTEX_ARRAY_POINTER, local.vertex_array.pointer},
        {GL_NORMAL_ARRAY_POINTER, local.normal_array.pointer},
        {GL_COLOR_ARRAY_POINTER, local.color_array.pointer},
        {GL_SECONDARY_COLOR_ARRAY_POINTER, local.secondary_color_array.pointer},
        {GL_FOG_COORD_ARRAY_POINTER, local.fog_coord_array.pointer},
        {GL_INDEX_ARRAY_POINTER, local.index_array.pointer},
        {GL_EDGE_FLAG_ARRAY_POINTER, local.edge_flag_array.pointer},
        {GL_TEXTURE_COORD_ARRAY_POINTER, local.texcoord_array[local.client_active_texture - GL_TEXTURE0].pointer},
    };
    for (const auto& row : rows)
        if (row.pname == pname) return known = true, reinterpret_cast<const void*>(row.pointer);
    return nullptr;
}

}  // namespace

const GLubyte* GetString(Context& c, GLenum name) {
    const Caps& caps = c.session().caps();
    if (name == GL_VENDOR) return kept("WallGL");
    if (name == GL_RENDERER) return kept("WallGL (" + caps.renderer + ")");
    if (name == GL_VERSION) return kept(version_string(caps));
    if (name == GL_EXTENSIONS) return kept(joined(offered_extensions(caps)));
    const GlVersion version = offered_version(caps);
    if (name == GL_SHADING_LANGUAGE_VERSION && version.shading_language) return kept(version.shading_language);
    c.error(GL_INVALID_ENUM);
    return nullptr;
}

const GLubyte* GetStringi(Context& c, GLenum name, GLuint index) {
    const auto extensions = offered_extensions(c.session().caps());
    if (name != GL_EXTENSIONS) return c.error(GL_INVALID_ENUM), nullptr;
    if (index >= extensions.size()) return c.error(GL_INVALID_VALUE), nullptr;
    return kept(extensions[index]);
}

void GetPointerv(Context& c, GLenum pname, void** params) {
    bool known = pname == GL_FEEDBACK_BUFFER_POINTER || pname == GL_SELECTION_BUFFER_POINTER;
    if (known)
        *params = pname == GL_FEEDBACK_BUFFER_POINTER ? static_cast<void*>(c.select->feedback_buffer) : c.select->select_buffer;
    else if (const void* pointer = array_pointer(c, pname, known); known)
        *params = const_cast<void*>(pointer);
    else
        c.error(GL_INVALID_ENUM);
}

}  // namespace wall::client::api
