// SPDX-License-Identifier: MIT
// A vector whose elements are numbered by ids of one kind, from 0 on, so that no other number finds one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <utility>
#include <vector>

namespace wall {

template <class Id, class T>
class IdVector {
public:
    void push_back(T item) { items_.push_back(std::move(item)); }
    std::size_t size() const { return items_.size(); }
    bool contains(Id id) const { return id.value < items_.size(); }
    /// Only of an id that it contains.
    T& operator[](Id id) { return items_[id.value]; }
    const T& operator[](Id id) const { return items_[id.value]; }

    auto begin() { return items_.begin(); }
    auto end() { return items_.end(); }
    auto begin() const { return items_.begin(); }
    auto end() const { return items_.end(); }
    /// In order.
    auto ids() const {
        return std::views::iota(std::uint32_t{0}, static_cast<std::uint32_t>(items_.size())) |
               std::views::transform([](std::uint32_t number) { return Id(number); });
    }

private:
    std::vector<T> items_;
};

}  // namespace wall
