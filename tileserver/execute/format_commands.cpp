// SPDX-License-Identifier: MIT
#include "tileserver/execute/format_commands.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "common/glapi/format_words.h"
#include "common/glapi/texture_target.h"

namespace wall::tileserver {

/// 0 where the driver does not know a word, or nobody a target. (Mesa 22.3 answers -1 for the size of none.)
void FormatCommands::FormatQuery(RequestId request, GLenum target, GLenum internal_format) {
    std::array<GLint64, glapi::kFormatWords.size()> values{};
    const bool known = target == GL_RENDERBUFFER || glapi::find_target_word(target);
    for (std::size_t i = 0; known && i < values.size(); ++i)
        execution_.gl.GetInternalformati64v(target, internal_format, glapi::kFormatWords[i], 1, &values[i]);
    const auto bytes = std::as_bytes(std::span(values));
    execution_.output.reply(request, std::vector<std::byte>(bytes.begin(), bytes.end()));
}

}  // namespace wall::tileserver
