// SPDX-License-Identifier: MIT
#include "tileserver/objects/triangle_order.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <vector>

namespace wall::tileserver {
namespace {

constexpr unsigned kCacheVertices = 16;  ///< of the cache that an order is judged by: as small as any GPU's
constexpr double kWorthWhile = 0.98;     ///< of the vertices that are processed

/// How many vertices such a cache has to process.
unsigned processed(std::span<const std::uint32_t> indices, std::size_t vertices) {
    return meshopt_analyzeVertexCache(indices.data(), indices.size(), vertices, kCacheVertices, 0, 0)
        .vertices_transformed;
}

/// The same indices numbered from 0, so that what works on them takes memory for these only; `vertices[i]` is what i
/// was.
std::vector<std::uint32_t> numbered_anew(std::span<const std::uint32_t> indices, std::vector<std::uint32_t>& vertices) {
    vertices.assign(indices.begin(), indices.end());
    std::ranges::sort(vertices);
    vertices.erase(std::ranges::unique(vertices).begin(), vertices.end());
    std::vector<std::uint32_t> out(indices.size());
    std::ranges::transform(indices, out.begin(), [&](std::uint32_t index) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(vertices, index) - vertices.begin());
    });
    return out;
}

bool order_piece(std::span<std::uint32_t> indices) {
    std::vector<std::uint32_t> vertices;
    const std::vector<std::uint32_t> before = numbered_anew(indices, vertices);
    std::vector<std::uint32_t> after(before.size());
    meshopt_optimizeVertexCache(after.data(), before.data(), before.size(), vertices.size());
    if (processed(after, vertices.size()) > kWorthWhile * processed(before, vertices.size())) return false;
    std::ranges::transform(after, indices.begin(), [&](std::uint32_t index) { return vertices[index]; });
    return true;
}

}  // namespace

bool order_triangles(std::span<std::uint32_t> indices, std::size_t step) {
    const std::size_t whole = indices.size() / 3 * 3;
    bool ordered = false;
    for (std::size_t first = 0; first < whole; first += step)
        ordered = order_piece(indices.subspan(first, std::min(step, whole - first))) || ordered;
    return ordered;
}

}  // namespace wall::tileserver
