// SPDX-License-Identifier: MIT
// Living in a foreign process: our threads never run its signal handlers, a forked child is inert, and what must be
// done at the end of the process is done without static destructors. Any thread.
#pragma once

#include <signal.h>

#include <cstddef>
#include <string>

namespace wall::client {

/// While it lives, the calling thread takes no signal; threads started meanwhile never will.
class SignalsBlocked {
public:
    SignalsBlocked();
    ~SignalsBlocked();
    SignalsBlocked(const SignalsBlocked&) = delete;

private:
    sigset_t before_;
};

/// Starts watching for fork(); called when the library is loaded.
void watch_forks();
/// True in a child made by fork() without exec: none of our threads exist there, sockets belong to the parent.
bool in_forked_child();

/// `action` runs when the process ends normally (not in a forked child), the last one registered first. It runs in a
/// thread of its own, which exit() waits for, but not longer than all actions' `limit_ms` together: exit() may be
/// called in a signal handler that interrupted this very library, and what it held is never let go of then.
void at_process_end(void (*action)(), int limit_ms);

/// `action` runs in the calling thread when it ends, but not at exit(): programs still draw in their own exit handlers,
/// after the thread_local destructors. Once per thread and action.
void at_thread_end(void (*action)());

/// The name of the running program, for people.
std::string program_name();

}  // namespace wall::client
