// SPDX-License-Identifier: MIT
// Lets coroutines wait until something of the wall has changed. One thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>

namespace wall::net {

namespace asio = boost::asio;

class Changed {
public:
    using Clock = std::chrono::steady_clock;
    explicit Changed(const asio::any_io_executor& executor) : timer_(executor, Clock::time_point::max()) {}

    void notify() { timer_.cancel(); }
    /// Waits until the next notify(), or until `deadline`. Look again, the change may be another one.
    asio::awaitable<void> wait(Clock::time_point deadline);

private:
    asio::steady_timer timer_;
};

}  // namespace wall::net
