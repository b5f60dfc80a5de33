// SPDX-License-Identifier: MIT
// How a stream whose connection was lost comes to its node again (common/wire/frame.h).
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "common/base/result.h"
#include "common/base/unique_fd.h"

namespace wall::client {

/// To come to the node again, in a thread of their own: whoever writes streams waits for nobody.
class StreamAttempts {
public:
    struct Connection {
        UniqueFd fd;
        std::uint64_t received = 0;  ///< frames, by the node
    };
    /// What does not change from one to the next.
    struct Wanted {
        std::string address, hello;
        std::uint32_t stream = 0;
        std::uint64_t received = 0;  ///< frames, by us
    };
    /// Null if the process gets no thread.
    static std::shared_ptr<StreamAttempts> start(Wanted wanted);
    /// What came of them, once; nothing yet. Any thread.
    std::optional<Result<Connection>> take();
    void stop();

private:
    static Result<Connection> once(const Wanted& wanted, bool& refused);
    void run(const Wanted& wanted);

    std::mutex mutex_;
    bool stop_ = false;
    std::optional<Result<Connection>> outcome_;
};

}  // namespace wall::client
