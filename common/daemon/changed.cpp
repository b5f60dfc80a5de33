// SPDX-License-Identifier: MIT
#include "common/daemon/changed.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace wall::net {

asio::awaitable<void> Changed::wait(Clock::time_point deadline) {
    using namespace asio::experimental::awaitable_operators;
    constexpr auto tuple = asio::as_tuple(asio::use_awaitable);
    asio::steady_timer limit(timer_.get_executor(), deadline);
    co_await (timer_.async_wait(tuple) || limit.async_wait(tuple));
}

}  // namespace wall::net
