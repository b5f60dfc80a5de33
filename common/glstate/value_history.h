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
#include <vector>

namespace wall::glstate {

class ValueHistory {
public:
    static constexpr std::size_t kValueBytes = 64;  ///< values of this size are remembered: 4x4 matrices
    static constexpr std::size_t kDepth = 8;        ///< of each element; more would seldom be found again

    /// Where the value stands, the latest first.
    std::optional<std::uint32_t> find(std::uint32_t element, const void* value) const {
        const auto list = lists_.find(element);
        if (list == lists_.end()) return std::nullopt;
        for (std::size_t i = 0; i < list->second.size(); ++i)
            if (std::memcmp(list->second[i].data(), value, kValueBytes) == 0) return static_cast<std::uint32_t>(i);
        return std::nullopt;
    }

    /// The value at a place, which becomes the latest; empty if there is none.
    std::span<const std::byte> recall(std::uint32_t element, std::uint32_t place) {
        const auto list = lists_.find(element);
        if (list == lists_.end() || place >= list->second.size()) return {};
        std::rotate(list->second.begin(), list->second.begin() + place, list->second.begin() + place + 1);
        return list->second.front();
    }

    /// A value that was sent in full is the latest; the oldest falls out.
    void add(std::uint32_t element, const void* value) {
        auto& list = lists_[element];
        if (list.size() == kDepth) list.pop_back();
        std::memcpy(list.emplace(list.begin())->data(), value, kValueBytes);
    }

private:
    using Value = std::array<std::byte, kValueBytes>;
    std::map<std::uint32_t, std::vector<Value>> lists_;
};

}  // namespace wall::glstate
