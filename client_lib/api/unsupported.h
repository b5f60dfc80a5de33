// SPDX-License-Identifier: MIT
// What happens when a program calls a GL function that is not implemented. Any thread.
#pragma once

#include <cstddef>

namespace wall::client {

/// GL_INVALID_OPERATION in the current context; counted each time, logged the first time. `index`: of
/// kUnsupportedNames.
void report_unsupported(std::size_t index);

}  // namespace wall::client
