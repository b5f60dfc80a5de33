// SPDX-License-Identifier: MIT
// Bytes whose memory is not set before it is written: growing a vector of them touches nothing. For what comes from a
// socket and fills all of it.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace wall {

/// New elements are default-initialised, which sets no byte, where std::allocator would set them to zero.
template <class T>
struct UnsetAllocator : std::allocator<T> {
    template <class U>
    struct rebind {
        using other = UnsetAllocator<U>;
    };
    template <class U>
    void construct(U* at) noexcept {
        ::new (static_cast<void*>(at)) U;
    }
    template <class U, class... From>
    void construct(U* at, From&&... from) {
        std::construct_at(at, std::forward<From>(from)...);
    }
};

using RawBytes = std::vector<std::byte, UnsetAllocator<std::byte>>;

}  // namespace wall
