// SPDX-License-Identifier: MIT
// What is asked about the buffers at indexed targets (glGetIntegeri_v). The context's thread.
#pragma once

#include "client_lib/context/context.h"

namespace wall::client {

/// glGetInteger64i_v of a word of an indexed target. False: it is none. An index that is too large is an error, and
/// `value` stays as it is.
bool get_indexed_buffer(Context& c, GLenum pname, GLuint index, GLint64& value);

}  // namespace wall::client
