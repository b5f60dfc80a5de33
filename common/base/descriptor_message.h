// SPDX-License-Identifier: MIT
// A descriptor that goes to another process with bytes of a Unix socket (SCM_RIGHTS). Any thread.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>

#include "common/base/unique_fd.h"

namespace wall {

/// As send() with MSG_NOSIGNAL; the descriptor goes with the first of the bytes, which may be no fewer than one.
ssize_t send_with_descriptor(int socket, std::span<const std::byte> bytes, int descriptor);

/// As recv(). `with` takes the descriptor that came with the bytes, closed on exec, or is left as it is: at most one is
/// taken, more are closed by the kernel.
ssize_t receive_with_descriptor(int socket, std::span<std::byte> room, UniqueFd& with, int flags = 0);

}  // namespace wall
