// SPDX-License-Identifier: MIT
// The places in a stream of batches for parcels that other nodes hand on (common/wire/parcel.h), and those parcels that
// have come before their places. Pure; one thread, the time is an argument.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "common/base/ids.h"
#include "common/base/raw_bytes.h"

namespace wall::tileserver {

class AwaitedParcels {
public:
    using Clock = std::chrono::steady_clock;

    static constexpr std::size_t kMostEarly = std::size_t{64} << 20;  ///< bytes of parcels without a place
    static constexpr std::size_t kMostPlaces = 1 << 16;               ///< a program has about a hundred on their way
    static constexpr std::chrono::seconds kLongestWait{20};           ///< in which nothing comes

    /// A place in the stream: the parcel, if it is here.
    std::optional<RawBytes> await(std::uint32_t number, NodeIndex from, Clock::time_point now) {
        for (auto at = early_.begin(); at != early_.end() && at->first < number; at = early_.erase(at))
            early_bytes_ -= at->second.size();  // of a stream before this one
        last_ = number;
        auto here = early_.extract(number);
        if (here.empty()) {
            places_[number] = from;
            waits_since_ = std::max(waits_since_, now);
            return std::nullopt;
        }
        early_bytes_ -= here.mapped().size();
        return std::move(here.mapped());
    }
    /// Whether there is room for it, where so much waits to be drawn. There always is for what comes from the node that
    /// hands on the first that is awaited: nothing goes on before that, which may come behind this one.
    bool has_room(std::uint32_t number, NodeIndex from, std::size_t waiting, std::size_t most_waiting) const {
        if (!places_.empty() && places_.begin()->second == from) return true;
        if (places_.contains(number)) return waiting < most_waiting;
        return number <= last_ || early_bytes_ < kMostEarly;
    }
    /// It has come. What it is, if it has a place in the stream.
    std::optional<RawBytes> take(std::uint32_t number, RawBytes batch, Clock::time_point now) {
        waits_since_ = now;
        if (places_.erase(number) != 0) return std::optional(std::move(batch));
        if (number <= last_) return std::nullopt;  // of a stream before this one
        early_bytes_ += batch.size();
        auto& place = early_[number];
        early_bytes_ -= place.size();
        place = std::move(batch);
        return std::nullopt;
    }
    /// A piece of one has come.
    void note(Clock::time_point now) { waits_since_ = now; }
    /// Whether one is awaited of a node that is gone, as `gone` says.
    bool waits_for(const std::function<bool(NodeIndex)>& gone) const {
        return std::ranges::any_of(places_, [&](const auto& place) { return gone(place.second); });
    }
    /// Nothing has come for long.
    bool overdue(Clock::time_point now) const { return !places_.empty() && now > waits_since_ + kLongestWait; }
    bool too_many() const { return places_.size() > kMostPlaces; }

private:
    std::map<std::uint32_t, NodeIndex> places_;  // who hands it on
    std::map<std::uint32_t, RawBytes> early_;
    std::size_t early_bytes_ = 0;
    std::uint32_t last_ = 0;  // that had a place
    Clock::time_point waits_since_{};
};

}  // namespace wall::tileserver
