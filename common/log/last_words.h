// SPDX-License-Identifier: MIT
// What a daemon that crashes leaves in its log: which signal, where, and the calls that led there, as addresses for
// addr2line. systemd starts it again; without this nobody knows why.
#pragma once

#include <string>

namespace wall::log {

/// From now on SIGSEGV, SIGBUS, SIGILL, SIGFPE and SIGABRT write to standard error before they end the process as they
/// did before (with a core file where those are wanted). Nothing under AddressSanitizer, which says more. Code made at
/// run time, such as shaders of llvmpipe, has no call information: the stack may end there. At the start, one thread.
void leave_last_words(const std::string& program);

}  // namespace wall::log
