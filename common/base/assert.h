// SPDX-License-Identifier: MIT
// WALL_ASSERT: our own invariants, checked in release builds too. A daemon that fails one stops (systemd starts it
// again); never used for foreign input.
#pragma once

#include <cstdio>
#include <cstdlib>

#define WALL_ASSERT(condition)                                                                     \
    do {                                                                                           \
        if (!(condition)) [[unlikely]] {                                                           \
            std::fprintf(stderr, "%s:%d: assertion failed: %s\n", __FILE__, __LINE__, #condition); \
            std::abort();                                                                          \
        }                                                                                          \
    } while (false)
