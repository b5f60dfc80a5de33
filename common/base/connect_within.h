// SPDX-License-Identifier: MIT
// Connecting with a limit of time. Any thread.
#pragma once

#include <sys/socket.h>

#include <chrono>

namespace wall {

/// Connects a non-blocking socket and waits until `deadline` at most. 0, or what went wrong, as of errno; ETIMEDOUT: no
/// answer. A Unix socket whose queue is full for the moment, because many programs start at once, is asked again.
int connect_within(int fd, const sockaddr* to, socklen_t length, std::chrono::steady_clock::time_point deadline);

}  // namespace wall
