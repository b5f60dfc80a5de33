// SPDX-License-Identifier: MIT
#include "walld/changed.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/experimental/awaitable_operators.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <exception>

#include "common/log/log.h"

namespace wall::walld {

asio::awaitable<void> Changed::wait(Clock::time_point deadline) {
    using namespace asio::experimental::awaitable_operators;
    constexpr auto tuple = asio::as_tuple(asio::use_awaitable);
    asio::steady_timer limit(timer_.get_executor(), deadline);
    co_await (timer_.async_wait(tuple) || limit.async_wait(tuple));
}

void spawn(const asio::any_io_executor& executor, const char* name, asio::awaitable<void> work) {
    asio::co_spawn(executor, std::move(work), [name](std::exception_ptr failure) {
        try {
            if (failure) std::rethrow_exception(failure);
        } catch (const std::exception& error) {
            log::error("task_failed task={} error={}", log::plain(name), log::quoted(error.what()));
        }
    });
}

}  // namespace wall::walld
