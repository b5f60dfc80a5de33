// SPDX-License-Identifier: MIT
// What one session may take of a node, but for its objects (objects/object.h). A session that wants more is ended with
// a reason.
#pragma once

#include <cstddef>
#include <cstdint>

namespace wall::tileserver {

inline constexpr std::size_t kMaxSurfaces = 256;  ///< windows and pbuffers
inline constexpr std::size_t kMaxContexts = 1024;
inline constexpr std::int64_t kMaxLayerPixels = std::int64_t{1} << 28;  ///< pixels of all layers
inline constexpr std::int64_t kLayerPixelBytes = 16;                    ///< three colours, depth and stencil
inline constexpr std::uint32_t kMaxFeedbackEntries = 16u << 20;         ///< of a feedback or selection buffer

/// Vertices of one list of the driver: llvmpipe draws so many small triangles in some ms, and others may draw then.
inline constexpr std::uint64_t kRunPartVertices = 1 << 14;

}  // namespace wall::tileserver
