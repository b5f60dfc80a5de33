// SPDX-License-Identifier: MIT
// What the kernel says of this process, for /metrics. Any thread.
#pragma once

#include <cstdint>

namespace wall::walld {

struct ProcessFigures {
    double cpu_seconds = 0;  ///< user and system
    std::uint64_t resident_bytes = 0, open_files = 0;

    static ProcessFigures now();
};

}  // namespace wall::walld
