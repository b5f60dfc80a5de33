// SPDX-License-Identifier: MIT
// An axis-aligned box in object space, kept while vertices are packed (W3.2). Pure.
#pragma once

#include <emmintrin.h>

#include <limits>

namespace wall::geom {

struct Box {
    __m128 min = _mm_set1_ps(std::numeric_limits<float>::infinity());  // x, y, z, unused
    __m128 max = _mm_set1_ps(-std::numeric_limits<float>::infinity());

    void add(__m128 vertex) {
        min = _mm_min_ps(min, vertex);
        max = _mm_max_ps(max, vertex);
    }
    void add(const Box& other) {
        min = _mm_min_ps(min, other.min);
        max = _mm_max_ps(max, other.max);
    }
    /// Any projected position is possible.
    void make_unbounded() {
        min = _mm_set1_ps(-std::numeric_limits<float>::infinity());
        max = _mm_set1_ps(std::numeric_limits<float>::infinity());
    }
    bool empty() const { return _mm_comigt_ss(min, max); }
    bool unbounded() const { return _mm_comieq_ss(min, _mm_set_ss(-std::numeric_limits<float>::infinity())); }
};

}  // namespace wall::geom
