// SPDX-License-Identifier: MIT
// Batches of one stream on their way from the I/O thread to the render thread. One that another node hands on has its
// place among them before it is here (common/wire/parcel.h); nothing behind it comes out before it has come. Bounded by
// bytes: a full queue makes the I/O thread stop reading the socket, so that the client waits in the end. Thread-safe.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/raw_bytes.h"

namespace wall::tileserver {

class BatchQueue {
public:
    static constexpr std::size_t kHighWater = std::size_t{64} << 20;  ///< bytes; reading stops
    static constexpr std::size_t kLowWater = std::size_t{16} << 20;   ///< bytes; reading goes on
    static constexpr std::size_t kMostSpare = std::size_t{8} << 20;   ///< bytes of memory that is kept

    /// `on_room` is called by the render thread when a full queue has room again.
    explicit BatchQueue(std::function<void()> on_room) : on_room_(std::move(on_room)) {}

    /// False: full now; wait for on_room before the next push.
    bool push(RawBytes batch) {
        const std::lock_guard lock(mutex_);
        bytes_ += batch.size();
        batches_.push_back({std::move(batch), std::nullopt});
        full_ = bytes_ >= kHighWater;
        return !full_;
    }
    /// A place for the parcel of that number.
    void push_place(std::uint32_t number) {
        const std::lock_guard lock(mutex_);
        batches_.push_back({{}, number});
    }
    /// The parcel has come. False: there is no place for it.
    bool fill(std::uint32_t number, RawBytes batch) {
        const std::lock_guard lock(mutex_);
        const auto place = std::ranges::find(batches_, std::optional(number), &Entry::awaited);
        if (place == batches_.end()) return false;
        bytes_ += batch.size();
        *place = {std::move(batch), std::nullopt};
        full_ = full_ || bytes_ >= kHighWater;
        return true;
    }

    /// Looks at the next batch without taking it. Null: none. Render thread; valid until pop().
    const RawBytes* front() const {
        const std::lock_guard lock(mutex_);
        return batches_.empty() || batches_.front().awaited ? nullptr : &batches_.front().bytes;
    }
    RawBytes pop() {
        std::unique_lock lock(mutex_);
        RawBytes batch = std::move(batches_.front().bytes);
        batches_.pop_front();
        bytes_ -= batch.size();
        const bool room = full_ && bytes_ <= kLowWater;
        if (room) full_ = false;
        lock.unlock();
        if (room) on_room_();
        return batch;
    }

    /// The memory of a batch that nobody needs any more, for one that comes later: memory that is new costs the system
    /// more than the bytes that are put into it.
    void give_back(RawBytes batch) {
        const std::lock_guard lock(mutex_);
        if (spare_bytes_ + batch.capacity() > kMostSpare) return;
        spare_bytes_ += batch.capacity();
        spare_.push_back(std::move(batch));
    }
    /// Some memory that was given back, or none.
    RawBytes take_spare() {
        const std::lock_guard lock(mutex_);
        if (spare_.empty()) return {};
        RawBytes memory = std::move(spare_.back());
        spare_.pop_back();
        spare_bytes_ -= memory.capacity();
        return memory;
    }

    /// None of it is kept: nothing comes for a while.
    void forget_spares() {
        const std::lock_guard lock(mutex_);
        spare_.clear();
        spare_bytes_ = 0;
    }

    /// Of the batches that wait. Any thread.
    std::size_t bytes() const {
        const std::lock_guard lock(mutex_);
        return bytes_;
    }

private:
    struct Entry {
        RawBytes bytes;
        std::optional<std::uint32_t> awaited;  ///< the parcel that they are to be
    };

    mutable std::mutex mutex_;
    std::function<void()> on_room_;
    std::deque<Entry> batches_;
    std::vector<RawBytes> spare_;
    std::size_t spare_bytes_ = 0;
    std::size_t bytes_ = 0;
    bool full_ = false;
};

}  // namespace wall::tileserver
