// SPDX-License-Identifier: MIT
// The last values of each matrix of a context, kept alike at both ends of a stream, so that a value that comes back
// travels as its place in the list: programs go to and fro between a few projections in every frame. One thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>

namespace wall::glstate {

class ValueHistory {
public:
    static constexpr std::size_t kValueBytes = 64;  ///< values of this size are remembered: 4x4 matrices
    static constexpr std::size_t kDepth = 8;        ///< of each element; more would seldom be found again

    /// Where the value stands, the latest first.
    std::optional<std::uint32_t> find(std::uint32_t element, const void* value) const {
        const auto at = lists_.find(element);
        if (at == lists_.end()) return std::nullopt;
        const List& list = at->second;
        for (std::uint32_t i = 0; i < list.count; ++i)
            if (std::memcmp(list.values[list.order[i]].data(), value, kValueBytes) == 0) return i;
        return std::nullopt;
    }

    /// The value at a place, which becomes the latest; empty if there is none.
    std::span<const std::byte> recall(std::uint32_t element, std::uint32_t place) {
        const auto at = lists_.find(element);
        if (at == lists_.end() || place >= at->second.count) return {};
        return at->second.values[at->second.make_latest(place)];
    }

    /// A value that was sent in full is the latest; the oldest falls out.
    void add(std::uint32_t element, const void* value) {
        List& list = lists_[element];
        if (list.count < kDepth) list.order[list.count] = static_cast<std::uint8_t>(list.count), ++list.count;
        std::memcpy(list.values[list.make_latest(list.count - 1)].data(), value, kValueBytes);
    }

private:
    using Value = std::array<std::byte, kValueBytes>;
    /// Values stay where they are, their order changes: a program sets a matrix for every draw.
    struct List {
        std::array<Value, kDepth> values;
        std::array<std::uint8_t, kDepth> order;  ///< places of the values, the latest first
        std::uint32_t count = 0;

        std::uint8_t make_latest(std::uint32_t place) {
            std::rotate(order.begin(), order.begin() + place, order.begin() + place + 1);
            return order.front();
        }
    };
    std::map<std::uint32_t, List> lists_;
};

}  // namespace wall::glstate
