// SPDX-License-Identifier: MIT
#include "client_lib/context/element_bounds.h"

#include <algorithm>
#include <cstring>

namespace wall::client {
namespace {

/// Three floats without reading behind them.
__m128 load_three(const std::byte* at) {
    float v[4] = {0, 0, 0, 1};
    std::memcpy(v, at, 3 * sizeof(float));
    return _mm_loadu_ps(v);
}

__m128 load_any(const ArraySource& positions, const std::byte* at, bool& flat) {
    float v[4] = {0, 0, 0, 1};
    positions.load(at, positions.size, v);
    flat = flat && v[3] == 1;
    return _mm_loadu_ps(v);
}

/// The boxes of parts of a draw, and what has been seen of all of its elements so far.
class Bounding {
public:
    Bounding(const ArraySource& positions, const ElementRange& elements) : positions_(positions), elements_(elements) {}

    geom::Box box_of(std::size_t first, std::size_t end) {
        const auto indexed = [&](const auto* indices) {
            return around(first, end, [indices](std::size_t i) { return static_cast<GLuint>(indices[i]); });
        };
        switch (elements_.type) {
            case GL_UNSIGNED_BYTE: return indexed(static_cast<const GLubyte*>(elements_.indices));
            case GL_UNSIGNED_SHORT: return indexed(static_cast<const GLushort*>(elements_.indices));
            case GL_UNSIGNED_INT: return indexed(static_cast<const GLuint*>(elements_.indices));
            default:
                return around(first, end, [from = static_cast<std::size_t>(elements_.first)](std::size_t i) {
                    return static_cast<GLuint>(from + i);
                });
        }
    }
    GLuint first() const { return first_; }
    GLuint last() const { return last_; }
    bool flat() const { return flat_; }  ///< no w that would move a vertex

private:
    // What lies beyond the array has no place in the box: such a draw is not made as it stands.
    template <class ElementAt>
    geom::Box around(std::size_t first, std::size_t end, ElementAt&& element_at) {
        geom::Box box;
        const bool three_floats = positions_.type == GL_FLOAT && positions_.size == 3;
        constexpr std::uint64_t kNever = std::uint64_t{1} << 32;
        const std::uint64_t restart = elements_.type != 0 && elements_.restart ? *elements_.restart : kNever;
        const GLuint base = elements_.type != 0 ? static_cast<GLuint>(elements_.base_vertex) : 0;
        for (std::size_t i = first; i < end; ++i) {
            const GLuint index = element_at(i);
            if (index == restart) continue;
            const GLuint element = index + base;
            first_ = std::min(first_, element);
            last_ = std::max(last_, element);
            if (element >= positions_.count) continue;
            const std::byte* at = positions_.base + positions_.stride * element;
            box.add(three_floats ? load_three(at) : load_any(positions_, at, flat_));
        }
        return box;
    }

    const ArraySource& positions_;
    const ElementRange& elements_;
    GLuint first_ = ~GLuint{0}, last_ = 0;
    bool flat_ = true;
};

}  // namespace

ElementBounds bounds_of(const ArraySource& positions, const ElementRange& elements,
                        const std::optional<glstate::Cut>& cut) {
    ElementBounds out;
    Bounding bounding(positions, elements);
    const auto count = static_cast<std::size_t>(elements.count);
    const std::size_t step = cut ? cut->step : count, overlap = cut ? cut->overlap : 0;
    for (std::size_t first = 0; first < count; first += step) {
        const geom::Box box = bounding.box_of(first, std::min(first + step + overlap, count));
        out.box.add(box);
        if (cut) out.pieces.push_back(glstate::piece_box(box));
    }
    out.first = bounding.first();
    out.last = bounding.last();
    if (bounding.flat()) return out;
    out.box.make_unbounded();
    out.pieces.clear();
    return out;
}

}  // namespace wall::client
