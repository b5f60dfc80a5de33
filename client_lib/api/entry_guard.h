// SPDX-License-Identifier: MIT
// What a GL command ends in when something is thrown (guard.h). Any thread.
#pragma once

namespace wall::client {

/// Called in a handler `catch (...)`: GL_OUT_OF_MEMORY in the current context if that is what was caught. After
/// anything else the context is lost (Context::lose).
void entry_failed(const char* function);

}  // namespace wall::client
