// SPDX-License-Identifier: MIT
// Batches of one stream on their way from the I/O thread to the render thread. Bounded by bytes: a full queue makes the
// I/O thread stop reading the socket, so that the client waits in the end. Thread-safe.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace wall::tileserver {

class BatchQueue {
public:
    static constexpr std::size_t kHighWater = std::size_t{64} << 20;  ///< bytes; reading stops
    static constexpr std::size_t kLowWater = std::size_t{16} << 20;   ///< bytes; reading goes on

    /// `on_room` is called by the render thread when a full queue has room again.
    explicit BatchQueue(std::function<void()> on_room) : on_room_(std::move(on_room)) {}

    /// False: full now; wait for on_room before the next push.
    bool push(std::vector<std::byte> batch) {
        const std::lock_guard lock(mutex_);
        bytes_ += batch.size();
        batches_.push_back(std::move(batch));
        full_ = bytes_ >= kHighWater;
        return !full_;
    }

    /// Looks at the next batch without taking it. Null: none. Render thread; valid until pop().
    const std::vector<std::byte>* front() const {
        const std::lock_guard lock(mutex_);
        return batches_.empty() ? nullptr : &batches_.front();
    }
    std::vector<std::byte> pop() {
        std::unique_lock lock(mutex_);
        std::vector<std::byte> batch = std::move(batches_.front());
        batches_.pop_front();
        bytes_ -= batch.size();
        const bool room = full_ && bytes_ <= kLowWater;
        if (room) full_ = false;
        lock.unlock();
        if (room) on_room_();
        return batch;
    }

    /// Of the batches that wait. Any thread.
    std::size_t bytes() const {
        const std::lock_guard lock(mutex_);
        return bytes_;
    }

private:
    mutable std::mutex mutex_;
    std::function<void()> on_room_;
    std::deque<std::vector<std::byte>> batches_;
    std::size_t bytes_ = 0;
    bool full_ = false;
};

}  // namespace wall::tileserver
