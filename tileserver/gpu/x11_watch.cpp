// SPDX-License-Identifier: MIT
#include "tileserver/gpu/x11_watch.h"

#include <poll.h>
#include <sys/eventfd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace wall::tileserver {
namespace {

constexpr int kGrace = 5000;  // milliseconds from the server's end to the process's; in order it takes up to 2000

/// True: something has happened. `timeout` in milliseconds, -1: none.
bool wait_for(pollfd& what, int timeout) {
    int ready = 0;
    do ready = ::poll(&what, 1, timeout);
    while (ready < 0 && errno == EINTR);
    return ready > 0;
}

}  // namespace

X11Watch::X11Watch(int connection, std::string message)
    : stop_(::eventfd(0, EFD_CLOEXEC)),
      thread_([this, connection, message = std::move(message)] { run(connection, message); }) {}

X11Watch::~X11Watch() {
    ::eventfd_write(stop_.get(), 1);
    thread_.join();
}

void X11Watch::run(int connection, const std::string& message) const {
    pollfd both[] = {{stop_.get(), POLLIN, 0}, {connection, POLLRDHUP, 0}};
    while (::poll(both, 2, -1) < 0 && errno == EINTR) {
    }
    if (both[0].revents != 0 || wait_for(both[0], kGrace)) return;
    std::fputs(("tileserver: " + message + "\n").c_str(), stderr);
    std::_Exit(EXIT_FAILURE);
}

}  // namespace wall::tileserver
