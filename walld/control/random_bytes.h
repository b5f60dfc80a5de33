// SPDX-License-Identifier: MIT
// What nobody guesses. Any thread.
#pragma once

#include <sys/random.h>

#include <string>

#include "common/base/assert.h"

namespace wall::walld {

inline std::string random_bytes(std::size_t count) {
    std::string out(count, '\0');
    WALL_ASSERT(::getrandom(out.data(), count, 0) == static_cast<ssize_t>(count));
    return out;
}

}  // namespace wall::walld
