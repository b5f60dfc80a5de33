// SPDX-License-Identifier: MIT
// What a daemon does in the background: coroutines whose errors are logged, and those that must not end at all. One
// executor, one thread.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <functional>
#include <string>

#include "common/net/control_connection.h"

namespace wall::net {

/// Runs `work` in the background; what it throws is logged and ends only itself.
void spawn(const asio::any_io_executor& executor, const char* name, asio::awaitable<void> work);

/// Calls `look` every `interval` in the background until it gives false.
void look_again(const asio::any_io_executor& executor, const char* name, std::chrono::milliseconds interval,
                std::function<bool()> look);

/// A piece of work that is never over while the daemon lives.
struct LastingTask {
    std::string name;                             ///< for the log
    std::function<asio::awaitable<void>()> work;  ///< is called again when its coroutine has ended or thrown
    std::function<bool()> stopping;               ///< the daemon ends: no further call
    std::chrono::milliseconds pause{250};         ///< before the next call
};

/// Runs the task in the background until the daemon stops. What ends it before is logged, and it begins again after a
/// pause. Where even that is impossible, an exception leaves the executor's run(), and with it the process ends: it
/// never lives on without the task.
void keep_running(const asio::any_io_executor& executor, LastingTask task);

/// The same for a listener: `take` gets every connection. A listener that has lost its port, or was broken otherwise,
/// is opened again as often as need be. It must outlive the executor's handlers.
void keep_accepting(const asio::any_io_executor& executor, Listener& listener, std::function<void(StreamSocket)> take,
                    std::function<bool()> stopping);

/// Opens something that listens, at the start of a daemon. As long as another process has the address it tries again,
/// with one line in the log; any other error is given back. Blocks.
Result<void> listen_patiently(const std::function<Result<void>()>& listen);

}  // namespace wall::net
