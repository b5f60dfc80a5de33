// SPDX-License-Identifier: MIT
// Sizes of points out of an array (GL_OES_point_size_array). Nodes' drivers have fixed function with one size for all
// points of a draw, so that a draw is taken apart into runs of one size.
#include <algorithm>
#include <bit>
#include <cstring>

#include "client_lib/api/array_draws.h"
#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/client_arrays.h"
#include "common/glapi/convert.h"

namespace wall::client::api {
namespace {

namespace el = glstate::el;

constexpr GLfloat kUsualSize = 1;

/// The array, where the program or a buffer has it.
class Sizes {
public:
    explicit Sizes(Context& c) : array_(c.state.vertex_arrays.point_size_array) {
        const auto pointer = static_cast<std::uintptr_t>(array_.pointer);
        stride_ = array_.stride != 0 ? static_cast<std::size_t>(array_.stride) : kBytes;
        base_ = reinterpret_cast<const std::byte*>(pointer);
        if (array_.buffer == 0) return;
        reading_ = buffer_content(c, ClientName(array_.buffer), pointer);
        const std::size_t bytes = reading_.bytes().size();
        base_ = reading_.bytes().data();
        count_ = bytes < kBytes ? 0 : (bytes - kBytes) / stride_ + 1;
    }
    bool exist() const { return base_ != nullptr; }
    /// What lies beyond a buffer, and what is no size, is drawn with the usual one: OpenGL ES leaves both undefined.
    GLfloat of(std::size_t element) const {
        if (element >= count_) return kUsualSize;
        GLuint bits;
        std::memcpy(&bits, base_ + element * stride_, sizeof bits);
        const GLfloat size =
            array_.type == GL_FIXED ? glapi::from_fixed(static_cast<GLfixed>(bits)) : std::bit_cast<GLfloat>(bits);
        return size > 0 ? size : kUsualSize;
    }

private:
    static constexpr std::size_t kBytes = 4;
    const glstate::ClientArray& array_;
    BufferReading reading_;
    const std::byte* base_;
    std::size_t stride_;
    std::size_t count_ = ArraySource::kNoLimit;
};

/// The part of a draw from its element `from` on.
ArrayDraw part_of(const ArrayDraw& draw, GLsizei from, GLsizei count) {
    ArrayDraw part = draw;
    part.count = count;
    const auto skipped = static_cast<std::size_t>(from) * glstate::index_bytes(draw.index_type);
    if (draw.index_type == 0) part.first += from;
    else part.indices = reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(draw.indices) + skipped);
    return part;
}

}  // namespace

bool draw_by_sizes(Context& c, const ArrayDraw& whole) {
    const auto& arrays = c.state.vertex_arrays;
    if (whole.mode != GL_POINTS || !arrays.point_size_array.enabled) return false;
    const Sizes sizes(c);
    ElementRange elements{
        .first = whole.first, .count = whole.count, .type = whole.index_type, .indices = whole.indices};
    BufferReading reading;
    if (const ClientName buffer(arrays.element_array_buffer); whole.index_type != 0 && buffer) {
        reading = buffer_content(c, buffer, reinterpret_cast<std::uintptr_t>(whole.indices));
        const std::size_t have = reading.bytes().size() / glstate::index_bytes(whole.index_type);
        elements.indices = reading.bytes().data();
        elements.count = static_cast<GLsizei>(std::min<std::size_t>(static_cast<std::size_t>(whole.count), have));
    }
    if (!sizes.exist() || (whole.index_type != 0 && !elements.indices)) return false;
    const GLfloat before = c.get<el::point_size>();
    for (GLsizei i = 0, next = 0; i < elements.count; i = next) {
        const GLfloat size = sizes.of(elements.at(i));
        while (next < elements.count && sizes.of(elements.at(next)) == size) ++next;
        c.set<el::point_size>(0, size);
        draw_of_one_size(c, part_of(whole, i, next - i));
    }
    c.set<el::point_size>(0, before);
    return true;
}

}  // namespace wall::client::api
