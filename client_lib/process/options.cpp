// SPDX-License-Identifier: MIT
#include "client_lib/process/options.h"

#include <cstdlib>
#include <cstring>

namespace wall::client {
namespace {

bool flag(const char* name) {
    const char* value = secure_getenv(name);
    return value && std::strcmp(value, "1") == 0;
}

}  // namespace

const Options& options() {
    static const Options read{flag("WALLGL_BROADCAST"), flag("WALLGL_IDEAL"), flag("WALLGL_SHOWN_ONLY")};
    return read;
}

}  // namespace wall::client
