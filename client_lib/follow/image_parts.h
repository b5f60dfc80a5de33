// SPDX-License-Identifier: MIT
// Which part of its images each node draws, of a target made of objects that is only copied to a window as it is
// (drawn_parts.h). Never changes.
#pragma once

#include <cstdint>
#include <vector>

#include "client_lib/geometry/target_layers.h"

namespace wall::client {

struct ImageParts {
    std::uint64_t stamp = 0;          ///< when they were made
    std::vector<TargetLayer> layers;  ///< of all nodes; the area of each is its part, in pixels of the images

    /// How large the images are meanwhile, as the window is on the wall if it is shown larger; 0: as they are.
    std::uint32_t images_width = 0, images_height = 0;

    // What that follows from.
    SurfaceId window;
    std::uint32_t layout = 0;         ///< of the window: its version
    std::uint64_t nodes = 0;          ///< Nodes::changes()
    std::uint64_t definition = 0;     ///< DrawnTarget::defined()
    std::uint64_t between = 0;        ///< stamp of the parts of the target that it is copied to; 0: that is the window
    std::int32_t x = 0, y = 0;        ///< where its first pixel comes there
    double scale_x = 1, scale_y = 1;  ///< canvas pixels for one of the window's; 1: it is not larger there
    std::int32_t window_x = 0, window_y = 0;  ///< where its first pixel comes in the end
};

}  // namespace wall::client
