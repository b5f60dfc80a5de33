// SPDX-License-Identifier: MIT
#include "tileserver/objects/index_orders.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "common/glstate/vertex_input.h"
#include "tileserver/objects/triangle_order.h"

namespace wall::tileserver {
namespace {

template <class T>
bool order_as(std::span<std::byte> bytes, std::size_t step) {
    std::vector<T> indices(bytes.size() / sizeof(T));
    std::memcpy(indices.data(), bytes.data(), bytes.size());
    std::vector<std::uint32_t> wide(indices.begin(), indices.end());
    if (!order_triangles(wide, step)) return false;
    std::ranges::transform(wide, indices.begin(), [](std::uint32_t index) { return static_cast<T>(index); });
    std::memcpy(bytes.data(), indices.data(), bytes.size());
    return true;
}

bool order(GLenum type, std::span<std::byte> bytes, std::size_t step) {
    if (type == GL_UNSIGNED_BYTE) return order_as<std::uint8_t>(bytes, step);
    return type == GL_UNSIGNED_SHORT ? order_as<std::uint16_t>(bytes, step) : order_as<std::uint32_t>(bytes, step);
}

std::uint32_t bytes_of(const IndexRange& range) {
    return range.count * static_cast<std::uint32_t>(glstate::index_bytes(range.type));
}

/// Less than `wait`: of each range its own, for as long as the program runs.
unsigned longer(unsigned wait, GLuint buffer, const IndexRange& range) {
    constexpr std::uint32_t kMixing = 2654435761u;  // Knuth's, of multiplicative hashing
    return ((buffer * kMixing) ^ ((range.offset + range.count) * kMixing)) >> 8 & (wait - 1);
}

}  // namespace

GLuint IndexOrders::drawn(GLuint buffer, const IndexRange& range) {
    if (range.count < kLeastIndices) return 0;
    const auto found = copies_.find(range);
    if (found == copies_.end() && copies_.size() == kMostRanges) return 0;
    Copy& copy = found == copies_.end() ? copies_[range] : found->second;
    if (copy.useless || ++copy.draws < wait_ + longer(wait_, buffer, range)) return 0;
    if (copy.buffer == 0) make(copy, buffer, range);
    if (copy.in_order < range.count) go_on(copy, range);
    return copy.buffer;
}

void IndexOrders::make(Copy& copy, GLuint from, const IndexRange& range) {
    const Gl& gl = driver_.gl();
    const std::uint32_t bytes = bytes_of(range);
    driver_.drain_errors();
    gl.CreateBuffers(1, &copy.buffer);
    gl.NamedBufferData(copy.buffer, bytes, nullptr, GL_STATIC_DRAW);
    gl.CopyNamedBufferSubData(from, copy.buffer, range.offset, 0, bytes);
    bytes_ += bytes;
    if (driver_.drain_errors() == 0) return;
    drop(copy, range);
    copy.useless = true;
}

void IndexOrders::go_on(Copy& copy, const IndexRange& range) {
    if (copy.buffer == 0) return;
    const auto one = static_cast<std::uint32_t>(glstate::index_bytes(range.type));
    const std::uint32_t step = range.step != 0 ? range.step : kIndicesADraw;
    const std::uint32_t count = std::min(std::max(kIndicesADraw / step, 1u) * step, range.count - copy.in_order);
    std::vector<std::byte> part(std::size_t{count} * one);
    driver_.gl().GetNamedBufferSubData(copy.buffer, std::intptr_t{copy.in_order} * one,
                                       static_cast<GLsizeiptr>(part.size()), part.data());
    if (order(range.type, part, step)) {
        driver_.write_buffer(copy.buffer, copy.in_order * one, part);
        copy.better = true;
    }
    copy.in_order += count;
    if (copy.in_order < range.count || copy.better) return;
    drop(copy, range);
    copy.useless = true;
}

void IndexOrders::drop(Copy& copy, const IndexRange& range) {
    driver_.gl().DeleteBuffers(1, &copy.buffer);
    copy.buffer = 0;
    bytes_ -= bytes_of(range);
}

void IndexOrders::forget() {
    if (copies_.empty()) return;
    if (std::ranges::any_of(copies_, [](const auto& entry) { return entry.second.in_order > 0; }))
        wait_ = std::min(2 * wait_, kLongestWait);
    for (auto& [range, copy] : copies_)
        if (copy.buffer != 0) drop(copy, range);
    copies_.clear();
}

}  // namespace wall::tileserver
