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
    /// What was on its way from one node to the next one may not have come there: the streams of those behind.
    Streams not_handed_on(NodeIndex from, NodeIndex to, Clock::time_point now) {
        const std::lock_guard lock(mutex_);
        Streams out = take_from([&](const std::vector<Stop>& route) {
            const auto at = std::ranges::find(route, from, &Stop::node);
            return at != route.end() && at + 1 != route.end() && (at + 1)->node == to ? at + 1 : route.end();
        });
        if (!out.empty() && now >= again_) {
            again_ = now + pause_;
            pause_ = std::min(2 * pause_, kLongestPause);
        }
        return out;
    }
    /// What was on its way through that stream's node may not come to those behind it: their streams.
    Streams lost(const std::shared_ptr<Stream>& stream) {
        const std::lock_guard lock(mutex_);
        return take_from([&](const std::vector<Stop>& route) {
            const auto at = std::ranges::find_if(route, [&](const Stop& s) { return s.stream.lock() == stream; });
            return at == route.end() ? at : at + 1;
        });
    }

private:
    struct Parcel {
        std::uint32_t number;
        std::vector<Stop> route;
    };
    /// Forgets parcels whose routes have something behind `behind(route)`: the streams from there on.
    template <class Behind>
    Streams take_from(const Behind& behind) {
        Streams out;
        std::erase_if(parcels_, [&](const Parcel& parcel) {
            const auto first = behind(parcel.route);
            for (auto stop = first; stop != parcel.route.end(); ++stop)
                if (auto stream = stop->stream.lock();
                    stream && !stream->failed() && std::ranges::find(out, stream) == out.end())
                    out.push_back(std::move(stream));
            return first != parcel.route.end();
        });
        return out;
    }

    const bool wanted_;
    mutable std::mutex mutex_;
    std::uint32_t last_ = 0;
    std::deque<Parcel> parcels_;  ///< on their way
    Clock::time_point again_{};   ///< until then not
    std::chrono::seconds pause_ = kPause;
};

}  // namespace wall::client
