// SPDX-License-Identifier: MIT
#include "common/daemon/keep_running.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/this_coro.hpp>
#include <exception>
#include <thread>
#include <utility>

#include "common/log/log.h"
#include "common/net/as_tuple.h"
#include "common/net/sockets.h"

namespace wall::net {
namespace {

constexpr std::chrono::seconds kListenAgain{1};  // while another process has the address

/// Why the work has ended; GCC 12 has no co_await in a handler.
asio::awaitable<std::string> run_once(const LastingTask& task) {
    try {
        co_await task.work();
    } catch (const std::exception& error) {
        co_return error.what();
    }
    co_return "it has ended";
}

asio::awaitable<void> look_until_false(std::chrono::milliseconds interval, std::function<bool()> look) {
    asio::steady_timer timer(co_await asio::this_coro::executor);
    do {
        timer.expires_after(interval);
        co_await timer.async_wait(net::kTuple);
    } while (look());
}

asio::awaitable<void> run_for_ever(LastingTask task) {
    asio::steady_timer timer(co_await asio::this_coro::executor);
    while (!task.stopping()) {
        const auto why = co_await run_once(task);
        if (task.stopping()) break;
        log::error("task_failed task={} error={} again_in_ms={}", log::quoted(task.name), log::quoted(why),
                   task.pause.count());
        timer.expires_after(task.pause);
        co_await timer.async_wait(net::kTuple);
    }
}

asio::awaitable<void> accept_all(Listener& listener, std::function<void(StreamSocket)> take,
                                 std::function<bool()> stopping) {
    for (;;) {
        auto socket = co_await listener.accept();
        if (stopping()) co_return;
        if (socket) {
            take(std::move(*socket));
            continue;
        }
        log::error("listener_lost error={}", log::quoted(socket.error().message));
        while (!stopping()) {
            const auto again = listener.reopen();
            if (again) break;
            log::error("listener_failed error={}", log::quoted(again.error().message));
            asio::steady_timer pause(co_await asio::this_coro::executor, kListenAgain);
            co_await pause.async_wait(net::kTuple);
        }
        if (!stopping()) log::info("listening_again address={}", log::quoted(listener.address().text()));
    }
}

}  // namespace

void spawn(const asio::any_io_executor& executor, const char* name, asio::awaitable<void> work) {
    asio::co_spawn(executor, std::move(work), [name](std::exception_ptr failure) {
        try {
            if (failure) std::rethrow_exception(failure);
        } catch (const std::exception& error) {
            log::error("task_failed task={} error={}", log::plain(name), log::quoted(error.what()));
        }
    });
}

void look_again(const asio::any_io_executor& executor, const char* name, std::chrono::milliseconds interval,
                std::function<bool()> look) {
    spawn(executor, name, look_until_false(interval, std::move(look)));
}

void keep_running(const asio::any_io_executor& executor, LastingTask task) {
    asio::co_spawn(executor, run_for_ever(std::move(task)), [](std::exception_ptr failure) {
        if (failure) std::rethrow_exception(failure);
    });
}

void keep_accepting(const asio::any_io_executor& executor, Listener& listener, std::function<void(StreamSocket)> take,
                    std::function<bool()> stopping) {
    auto work = [&listener, take = std::move(take), stopping] { return accept_all(listener, take, stopping); };
    keep_running(executor, {"accept " + listener.address().text(), std::move(work), std::move(stopping)});
}

Result<void> listen_patiently(const std::function<Result<void>()>& listen) {
    for (bool said = false;; std::this_thread::sleep_for(kListenAgain)) {
        auto listening = listen();
        if (listening || !is_address_taken(listening.error())) return listening;
        if (!std::exchange(said, true))
            log::error("listen_failed error={} again_in_s={}", log::quoted(listening.error().message),
                       kListenAgain.count());
    }
}

}  // namespace wall::net
