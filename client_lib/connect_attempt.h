// SPDX-License-Identifier: MIT
// A connection to a node that is tried in a thread of its own, so that the program goes on meanwhile: a node that did
// not answer when the program started may take long to do so, or may have been stopped.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "client_lib/node_stream.h"

namespace wall::client {

class ConnectAttempt {
public:
    /// Null if the process gets no thread. The arguments are those of NodeStream::open().
    static std::shared_ptr<ConnectAttempt> start(std::string address, std::string hello, int timeout_ms);
    /// What came of it; nothing yet, or it was taken before. Any thread.
    std::optional<Result<std::shared_ptr<NodeStream>>> take();

private:
    std::mutex mutex_;
    std::optional<Result<std::shared_ptr<NodeStream>>> outcome_;
};

}  // namespace wall::client
