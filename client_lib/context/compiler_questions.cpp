// SPDX-License-Identifier: MIT
#include "client_lib/context/compiler_questions.h"

#include <span>
#include <string>

namespace wall::client {

AnswerCache& kept_answers() {
    static auto* const kept = new AnswerCache(AnswerCache::usual_folder());  // for as long as the process runs
    return *kept;
}

glapi::ContentHash compiler_question(Context& c) {
    const Caps& caps = c.session().caps();
    std::string wall = std::to_string(glapi::kStreamVersion);
    for (const std::string* name : {&caps.vendor, &caps.renderer, &caps.version, &caps.shading_language_version})
        wall += '\n' + *name;
    glapi::ContentHash hash;
    hash.ShaderCompile(0, std::as_bytes(std::span(wall)));
    return hash;
}

}  // namespace wall::client
