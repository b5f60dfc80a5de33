// SPDX-License-Identifier: MIT
// A connection to a node that is made in a thread of its own: several nodes are asked at once, and the program goes on
// beside one that takes long to answer, or has been stopped.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "client_lib/link/node_stream.h"

namespace wall::client {

class ConnectAttempt {
public:
    /// Null if the process gets no thread. `address`, `hello` and `timeout_ms` are those of NodeStream::open().
    /// `opened` is called in that thread when a stream was opened and can be taken; it must not refer to anything that
    /// may be gone by then.
    static std::shared_ptr<ConnectAttempt> start(
        std::string address, std::string hello, int timeout_ms, std::function<void()> opened = [] {});
    /// What came of it; nothing yet, or it was taken before. Any thread.
    std::optional<Result<std::shared_ptr<NodeStream>>> take();
    /// Waits until something came of it, or the time is over. Any thread.
    void wait_until(std::chrono::steady_clock::time_point deadline);

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool done_ = false;
    std::optional<Result<std::shared_ptr<NodeStream>>> outcome_;
};

}  // namespace wall::client
