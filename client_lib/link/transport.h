// SPDX-License-Identifier: MIT
// The one background thread that moves bytes of all node streams. Started with the first stream, signals blocked;
// ended by the destructor.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "client_lib/link/node_stream.h"

namespace wall::client {

class Transport {
public:
    /// `on_failure` is called in the transport's thread after a stream has failed; it must not wait for anybody who
    /// waits for a stream.
    explicit Transport(std::function<void()> on_failure);
    ~Transport();

    void add(std::shared_ptr<NodeStream> stream);
    void remove(const NodeStream* stream);
    /// All streams fail, so that nobody waits for them. Any thread.
    void give_up_all(const std::string& why);
    /// Something was queued.
    void wake();
    /// Sends what is queued, for at most `timeout_ms`, e.g. before the process ends.
    void drain(int timeout_ms);

private:
    void run();

    const std::function<void()> on_failure_;
    UniqueFd wake_fd_;
    std::atomic<bool> stop_{false};
    std::atomic<bool> wake_pending_{false};
    std::mutex mutex_;
    std::vector<std::shared_ptr<NodeStream>> streams_;
    std::thread thread_;
};

}  // namespace wall::client
