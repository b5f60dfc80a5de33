// SPDX-License-Identifier: MIT
// Whether this process was stopped (SIGSTOP, a debugger, a shell's Ctrl-Z) and has gone on: what was measured across
// that says nothing. The thread that measures hears it before it does anything else, since it alone takes the signal.
#pragma once

#include <signal.h>

#include <atomic>

namespace wall::tileserver::continued {

inline std::atomic<unsigned> times{0};  ///< that it has gone on

/// Before there are threads. Without it nothing is noticed.
inline void expect() {
    struct sigaction action {};
    action.sa_handler = [](int) { times.fetch_add(1, std::memory_order_relaxed); };
    action.sa_flags = SA_RESTART;
    ::sigaction(SIGCONT, &action, nullptr);
    sigset_t set;
    ::sigemptyset(&set);
    ::sigaddset(&set, SIGCONT);
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);  // a stopped process goes on all the same
}

/// In the thread that measures.
inline void hear() {
    sigset_t set;
    ::sigemptyset(&set);
    ::sigaddset(&set, SIGCONT);
    ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

inline unsigned count() { return times.load(std::memory_order_relaxed); }

}  // namespace wall::tileserver::continued
