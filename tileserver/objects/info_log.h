// SPDX-License-Identifier: MIT
// The text that the driver keeps of compiling and linking. Render thread.
#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include "common/glapi/gl_types.h"

namespace wall::tileserver {

/// What a Get*InfoLog function gives.
template <class GetLength, class GetLog>
std::string read_log(GetLength&& get_length, GetLog&& get_log) {
    GLint length = 0;
    get_length(&length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    GLsizei written = 0;
    get_log(static_cast<GLsizei>(log.size()), &written, log.data());
    log.resize(static_cast<std::size_t>(std::max(written, 0)));
    return log;
}

}  // namespace wall::tileserver
