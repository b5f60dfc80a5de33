// SPDX-License-Identifier: MIT
// The first words between a program and a node: hello, and what the node says to it. Any thread; they wait.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "common/base/result.h"
#include "common/base/unique_fd.h"
#include "common/wire/frame.h"

namespace wall::client {

/// Opens a stream socket to `unix:PATH` or `HOST:PORT`, non-blocking; at most `timeout_ms`.
Result<UniqueFd> connect_to(const std::string& address, int timeout_ms);

/// What a node says to a hello.
struct Answer {
    wire::FrameKind kind{};
    std::uint64_t number = 0;  ///< that comes with it
    std::string why;           ///< it does not take the stream

    /// The node does not, and will not.
    bool refuses() const { return kind == wire::FrameKind::error; }
};

struct Greeting {
    UniqueFd fd;
    Answer answer;
};

/// Connects and says hello, an encoded DataHello, and with it sends a descriptor; -1: none. The error says that nobody
/// has answered in time, or not as a node does.
Result<Greeting> greet_node(const std::string& address, const std::string& hello, int descriptor,
                            std::chrono::steady_clock::time_point deadline);

}  // namespace wall::client
