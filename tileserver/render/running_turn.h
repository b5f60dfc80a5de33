// SPDX-License-Identifier: MIT
// Whose turn the render thread is executing, for others to see: a call of the driver may never come back. Thread-safe.
#pragma once

#include <chrono>
#include <mutex>
#include <optional>

#include "common/base/ids.h"

namespace wall::tileserver {

using StreamId = Id<struct StreamTag>;  ///< of one data connection, unique in the process

struct RunningTurn {
    StreamId stream;
    SessionId session;
    std::chrono::steady_clock::time_point since;
};

class TurnBoard {
public:
    void begin(const RunningTurn& turn) {
        const std::lock_guard lock(mutex_);
        turn_ = turn;
    }
    void end() {
        const std::lock_guard lock(mutex_);
        turn_.reset();
    }
    std::optional<RunningTurn> now() const {
        const std::lock_guard lock(mutex_);
        return turn_;
    }

private:
    mutable std::mutex mutex_;
    std::optional<RunningTurn> turn_;
};

}  // namespace wall::tileserver
