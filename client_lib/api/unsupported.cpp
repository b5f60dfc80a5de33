// SPDX-License-Identifier: MIT
#include "client_lib/api/unsupported.h"

#include "client_lib/api/entry_guard.h"
#include "client_lib/context/context.h"
#include "client_lib/process/log.h"
#include "client_lib/process/stats.h"
#include "gen/client_lib/api.gen.h"

namespace wall::client {

void report_unsupported(std::size_t index) {
    const char* name = kUnsupportedNames[index];
    if (tls_context) tls_context->error(GL_INVALID_OPERATION);
    try {
        if (stats().count_unsupported(name)) log(LogLevel::warn, "unsupported function=%s", name);
    } catch (...) {
        entry_failed(name);
    }
}

}  // namespace wall::client
