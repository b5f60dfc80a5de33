// SPDX-License-Identifier: MIT
// Whether a process's nodes hand parcels on to each other: where one could not reach the next, they do not for a while,
// and for ever longer ones. Knows the ways of parcels that have not come to the ends of their routes, so that nobody
// waits for one that never will. The time is an argument. Thread-safe.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "common/base/ids.h"

namespace wall::client {

/// `Stream`: to a node; has failed().
template <class Stream>
class HandingOn {
public:
    using Clock = std::chrono::steady_clock;
    using Streams = std::vector<std::shared_ptr<Stream>>;

    static constexpr std::chrono::seconds kPause{10}, kLongestPause{600};
    static constexpr std::size_t kMostRemembered = 4096;  ///< parcels

    struct Stop {
        NodeIndex node;
        std::weak_ptr<Stream> stream;
    };

    /// `wanted`: at all.
    explicit HandingOn(bool wanted) : wanted_(wanted) {}

    /// Not at all, or not now.
    bool open(Clock::time_point now) const {
        const std::lock_guard lock(mutex_);
        return wanted_ && now >= again_;
    }
    /// A new parcel that goes that way: its number.
    std::uint32_t begin(std::vector<Stop> route) {
        const std::lock_guard lock(mutex_);
        if (parcels_.size() == kMostRemembered) parcels_.pop_front();
        parcels_.push_back({++last_, std::move(route)});
        return last_;
    }
    /// All have got it.
    void handed_on(std::uint32_t number) {
        const std::lock_guard lock(mutex_);
        std::erase_if(parcels_, [&](const Parcel& parcel) { return parcel.number == number; });
    }
    /// It has not come to that node: the streams of those that do not get it.
    Streams not_handed_on(std::uint32_t number, NodeIndex to, Clock::time_point now) {
        Streams out;
        const std::lock_guard lock(mutex_);
        const auto parcel = std::ranges::find(parcels_, number, &Parcel::number);
        if (parcel == parcels_.end()) return out;
        add(std::ranges::find(parcel->route, to, &Stop::node), parcel->route.end(), out);
        parcels_.erase(parcel);
        if (!out.empty() && now >= again_) {
            again_ = now + pause_;
            pause_ = std::min(2 * pause_, kLongestPause);
        }
        return out;
    }
    /// What was on its way through that stream's node may not come to those behind it: their streams.
    Streams lost(const std::shared_ptr<Stream>& stream) {
        Streams out;
        const std::lock_guard lock(mutex_);
        std::erase_if(parcels_, [&](const Parcel& parcel) {
            const auto at =
                std::ranges::find_if(parcel.route, [&](const Stop& s) { return s.stream.lock() == stream; });
            if (at == parcel.route.end()) return false;
            add(at + 1, parcel.route.end(), out);
            return true;
        });
        return out;
    }

private:
    struct Parcel {
        std::uint32_t number;
        std::vector<Stop> route;
    };
    using At = typename std::vector<Stop>::const_iterator;

    static void add(At stop, At end, Streams& out) {
        for (; stop != end; ++stop)
            if (auto stream = stop->stream.lock();
                stream && !stream->failed() && std::ranges::find(out, stream) == out.end())
                out.push_back(std::move(stream));
    }

    const bool wanted_;
    mutable std::mutex mutex_;
    std::uint32_t last_ = 0;
    std::deque<Parcel> parcels_;  ///< on their way
    Clock::time_point again_{};   ///< until then not
    std::chrono::seconds pause_ = kPause;
};

}  // namespace wall::client
