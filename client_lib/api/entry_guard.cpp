// SPDX-License-Identifier: MIT
#include "client_lib/api/entry_guard.h"

#include "client_lib/context/context.h"
#include "client_lib/process/guard.h"

namespace wall::client {

void entry_failed(const char* function) {
    const Caught caught = caught_exception(function);
    Context* c = tls_context;
    if (!c) return;
    if (caught == Caught::no_memory) return c->error(GL_OUT_OF_MEMORY);
    c->lose();
    go_dark();
}

}  // namespace wall::client
