// SPDX-License-Identifier: MIT
// A second copy of those parts of an index buffer that are drawn again and again while the buffer stays as it is, with
// their triangles in an order that a GPU processes faster (triangle_order.h; O4). A copy is made as a whole at
// once and brought in order piece by piece, some with each draw, so that a large mesh holds up no frame for long: at
// any time it has the same triangles. Render thread.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>

#include "tileserver/driver/driver.h"

namespace wall::tileserver {

/// Part of a buffer of indices, as it is drawn.
struct IndexRange {
    GLenum type = 0;           ///< of an index
    std::uint32_t offset = 0;  ///< bytes
    std::uint32_t count = 0;   ///< indices
    std::uint32_t step = 0;    ///< triangles stay among so many indices, a multiple of 3; 0: anywhere near
    auto operator<=>(const IndexRange&) const = default;
};

class IndexOrders {
public:
    /// Draws before a range has a copy, and by chance up to twice as many, so that not all meshes of a program are
    /// ordered in one frame; of a buffer that changed when it had one, twice as many as before.
    static constexpr unsigned kFirstWait = 16, kLongestWait = 4096;
    static constexpr std::size_t kMostRanges = 1024;     ///< of a buffer
    static constexpr std::uint32_t kLeastIndices = 768;  ///< of a range; below, a copy costs more than it saves
    /// Indices that one draw brings in order, 3 to 10 ms of work; ranges without a step are cut so.
    static constexpr std::uint32_t kIndicesADraw = 3 << 14;

    explicit IndexOrders(Driver& driver) : driver_(driver) {}
    ~IndexOrders() { forget(); }
    IndexOrders(const IndexOrders&) = delete;

    /// The range lies in `buffer` (of the driver) and is drawn now. The driver's buffer that has the same triangles
    /// from its beginning on; 0: none, the buffer itself is drawn.
    GLuint drawn(GLuint buffer, const IndexRange& range);
    /// The buffer changes.
    void forget();
    /// Of the driver's memory.
    std::uint64_t bytes() const { return bytes_; }

private:
    struct Copy {
        unsigned draws = 0;
        GLuint buffer = 0;  // the driver's
        std::uint32_t in_order = 0;
        bool better = false;   // some of it
        bool useless = false;  // all of it was in a good order
    };
    void make(Copy& copy, GLuint from, const IndexRange& range);
    void go_on(Copy& copy, const IndexRange& range);
    void drop(Copy& copy, const IndexRange& range);

    Driver& driver_;
    std::map<IndexRange, Copy> copies_;
    std::uint64_t bytes_ = 0;
    unsigned wait_ = kFirstWait;
};

}  // namespace wall::tileserver
