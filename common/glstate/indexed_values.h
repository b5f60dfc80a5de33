// SPDX-License-Identifier: MIT
// State that each draw buffer, or each viewport, has for itself, but is mostly set for all of them (`rest` in
// proto/gl/state.toml): an element E with the first one's value, and R with those of the others. Pure.
#pragma once

#include <cstring>

#include "common/glstate/diff.h"
#include "gen/glstate/state.gen.h"

namespace wall::glstate {

/// Stands for the first one's value: all bits are set.
template <class T>
T as_the_first() {
    T value;
    std::memset(&value, 0xff, sizeof value);
    return value;
}

/// Whether all of them have the first one's.
template <class R>
bool none_has_its_own(const State& state) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(&R::ref(state, 0));
    unsigned char common = 0xff;  // looked at without a branch: many at once
    for (std::size_t i = 0; i < R::count * sizeof(typename R::type); ++i) common &= bytes[i];
    return common == 0xff;
}

template <class E, class R>
const typename E::type& value_at(const State& state, unsigned index) {
    const bool own = index != 0 && !same(R::ref(state, index - 1), as_the_first<typename R::type>());
    return own ? R::ref(state, index - 1) : E::ref(state);
}

}  // namespace wall::glstate
