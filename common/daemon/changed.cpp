// SPDX-License-Identifier: MIT
#include "common/daemon/changed.h"

#include <boost/asio/experimental/awaitable_operators.hpp>

#include "common/net/as_tuple.h"

namespace wall::net {

asio::awaitable<void> Changed::wait(Clock::time_point deadline) {
    using namespace asio::experimental::awaitable_operators;
    asio::steady_timer limit(timer_.get_executor(), deadline);
    co_await (timer_.async_wait(kTuple) || limit.async_wait(kTuple));
}

}  // namespace wall::net
