// SPDX-License-Identifier: MIT
#include "tileserver/objects/storage_access.h"

#include <cctype>
#include <cstddef>
#include <string>
#include <vector>

namespace wall::tileserver {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Behind a comment that begins at `at`; `at` itself: none does.
std::size_t behind_comment(std::string_view source, std::size_t at) {
    const auto behind = [&](std::string_view end, std::size_t from) {
        const std::size_t found = source.find(end, from);
        return found == source.npos ? source.size() : found + end.size();
    };
    if (source.substr(at, 2) == "//") return behind("\n", at);
    return source.substr(at, 2) == "/*" ? behind("*/", at + 2) : at;
}

/// Words and single other characters, without comments.
std::vector<std::string_view> tokens_of(std::string_view source) {
    std::vector<std::string_view> out;
    for (std::size_t at = 0; at < source.size();) {
        if (const std::size_t behind = behind_comment(source, at); behind != at) {
            at = behind;
            continue;
        }
        std::size_t end = at + 1;
        while (is_word(source[at]) && end < source.size() && is_word(source[end])) ++end;
        if (std::isspace(static_cast<unsigned char>(source[at])) == 0) out.push_back(source.substr(at, end - at));
        at = end;
    }
    return out;
}

/// Whether the declaration that has `buffer` at that place says that the block is only read.
bool says_readonly(const std::vector<std::string_view>& tokens, std::size_t buffer) {
    for (std::size_t at = buffer; at-- != 0;) {
        if (tokens[at] == "readonly") return true;
        if (tokens[at] == ";" || tokens[at] == "}") return false;
    }
    return false;
}

}  // namespace

bool is_only_read(const glapi::ProgramDefinition& definition, std::string_view block) {
    const std::string_view name = block.substr(0, block.find('['));
    bool declared = false;
    for (const glapi::ShaderSource& shader : definition.shaders) {
        if (shader.source.find(name) == std::string::npos) continue;
        const auto tokens = tokens_of(shader.source);
        bool here = false;
        for (std::size_t at = 0; at + 2 < tokens.size(); ++at) {
            if (tokens[at + 1] != name || tokens[at + 2] != "{") continue;
            // `readonly` may also stand behind `buffer`, in front of the name.
            const bool plain = tokens[at] == "buffer" || tokens[at] == "readonly";
            if (!plain || !says_readonly(tokens, at + 1)) return false;
            here = true;
        }
        if (!here) return false;
        declared = true;
    }
    return declared;
}

}  // namespace wall::tileserver
