// SPDX-License-Identifier: MIT
#include "client_lib/process/options.h"

#include <cstdlib>
#include <cstring>

namespace wall::client {
namespace {

bool is(const char* name, const char* wanted) {
    const char* value = secure_getenv(name);
    return value && std::strcmp(value, wanted) == 0;
}

Coding coding() {
    return is("WALLGL_CODING", "0") ? Coding::never : is("WALLGL_CODING", "1") ? Coding::always : Coding::measured;
}

}  // namespace

const Options& options() {
    static const Options read{is("WALLGL_BROADCAST", "1"), is("WALLGL_IDEAL", "1"), is("WALLGL_SHOWN_ONLY", "1"),
                              !is("WALLGL_RING", "0"), coding()};
    return read;
}

}  // namespace wall::client
