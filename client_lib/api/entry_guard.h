// SPDX-License-Identifier: MIT
// What a GL command ends in when something is thrown (guard.h). Any thread.
#pragma once

#include "client_lib/context/context.h"

namespace wall::client {

/// The end of a command: what it has to say about errors is said.
class EntryEnd {
public:
    explicit EntryEnd(Context& c) : c_(c) {}
    ~EntryEnd() { c_.tell_errors(); }
    EntryEnd(const EntryEnd&) = delete;

private:
    Context& c_;
};

/// Called in a handler `catch (...)`: GL_OUT_OF_MEMORY in the current context if that is what was caught. After
/// anything else the context is lost (Context::lose).
void entry_failed(const char* function);

}  // namespace wall::client
