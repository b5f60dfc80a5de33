// SPDX-License-Identifier: MIT
// Ctrl-C, or the end that a service manager asks for, during long work that then ends early and well.
#pragma once

namespace wall::wallctl {

/// From now on SIGINT and SIGTERM do not end the process.
void watch_for_interrupts();
/// Whether one has come. Any thread.
bool interrupted();

}  // namespace wall::wallctl
