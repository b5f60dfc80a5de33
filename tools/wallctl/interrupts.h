// SPDX-License-Identifier: MIT
// Ctrl-C, or the end that a service manager asks for, during long work that then ends early and well.
#pragma once

#include <cstddef>

namespace wall::wallctl {

/// From now on SIGINT and SIGTERM do not end the process.
void watch_for_interrupts();
/// How many have come. Any thread.
std::size_t interruptions();
inline bool interrupted() { return interruptions() != 0; }

}  // namespace wall::wallctl
