// SPDX-License-Identifier: MIT
// glGetString, glGetStringi.
#include <map>
#include <mutex>

#include "client_lib/context/assembly_use.h"
#include "client_lib/context/context.h"
#include "client_lib/context/es_version.h"

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

}  // namespace

const GLubyte* GetString(Context& c, GLenum name) {
    const Caps& caps = c.caps();
    if (name == GL_VENDOR) return kept("WallGL");
    if (name == GL_RENDERER) return kept("WallGL (" + caps.renderer + ")");
    if (name == GL_VERSION) return kept(version_text_in(c.profile, caps));
    if (name == GL_PROGRAM_ERROR_STRING_ARB && c.profile.has_begin()) return kept(c.assembly->message);
    if (name == GL_EXTENSIONS && !c.profile.core) return kept(joined(extensions_in(c.profile, caps)));
    if (name == GL_SHADING_LANGUAGE_VERSION)
        if (const std::string language = shading_language_in(c.profile, caps); !language.empty()) return kept(language);
    c.error(GL_INVALID_ENUM);
    return nullptr;
}

const GLubyte* GetStringi(Context& c, GLenum name, GLuint index) {
    if (name != GL_EXTENSIONS && name != GL_SHADING_LANGUAGE_VERSION) return c.error(GL_INVALID_ENUM), nullptr;
    const auto words =
        name == GL_EXTENSIONS ? extensions_in(c.profile, c.caps()) : shading_languages_in(c.profile, c.caps());
    if (index >= words.size()) return c.error(GL_INVALID_VALUE), nullptr;
    return kept(words[index]);
}

}  // namespace wall::client::api
