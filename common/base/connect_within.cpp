// SPDX-License-Identifier: MIT
#include "common/base/connect_within.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <thread>

namespace wall {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kAskAgain{2};

int left_ms(Clock::time_point deadline) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    return static_cast<int>(std::max<std::chrono::milliseconds::rep>(left, 0));
}

/// Until the connection is there or has failed. False: neither by then.
bool wait_for_outcome(int fd, Clock::time_point deadline) {
    pollfd wait{fd, POLLOUT, 0};
    for (;;) {
        const int n = ::poll(&wait, 1, left_ms(deadline));
        if (n >= 0 || errno != EINTR) return n > 0;
    }
}

}  // namespace

int connect_within(int fd, const sockaddr* to, socklen_t length, Clock::time_point deadline) {
    // EAGAIN is only said of Unix sockets (unix(7)); polling such a one would not wait.
    while (::connect(fd, to, length) != 0) {
        if (errno == EINPROGRESS) {
            if (!wait_for_outcome(fd, deadline)) return ETIMEDOUT;
            int error = 0;
            socklen_t size = sizeof error;
            ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
            return error;
        }
        if (errno != EAGAIN && errno != EINTR) return errno;
        if (Clock::now() >= deadline) return ETIMEDOUT;
        std::this_thread::sleep_for(kAskAgain);
    }
    return 0;
}

}  // namespace wall
