// SPDX-License-Identifier: MIT
// From where projectors lie on a screen to what wall.toml says of their tiles: rects that overlap as the projectors do,
// warps, and ramps. Pure.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/geom/tile_output.h"
#include "tools/wallcalibrate/curved_screen.h"

namespace wall::calibrate {

/// A projector as wall.toml has it before: which one of a grid it is, is told by where its tile lies.
struct Projector {
    std::string tile;
    geom::Rect rect;            ///< on the canvas
    int width = 0, height = 0;  ///< pixels of its output
    cv::Matx33d on_screen;      ///< from its pixels to any flat picture of the screen
    SeenMesh seen;              ///< the same, in that picture, of a screen that is not flat; no points: it is
};
/// Of a curved screen: where it lies, and about where its corners would be if the screen were flat.
void put(Projector& projector, SeenMesh seen);

struct PlannedTile {
    std::string tile;
    geom::Rect rect;
    int width = 0, height = 0;   ///< of the output
    geom::Warp warp;             ///< a homography; on a curved screen, a mesh
    std::array<int, 4> ramps{};  ///< by geom::Blend::Edge, pixels
};

/// Rows and columns of tiles whose rects are lit by all projectors that share them; the canvas has their mean density.
/// Where a projector shines past a curved screen's rim the rect goes as far as the screen does.
/// An error: they are no grid, or do not overlap.
Result<std::vector<PlannedTile>> plan_wall(std::span<const Projector> projectors);

/// A tile's lines of wall.toml, with its warp in a file of that name.
std::string tile_lines(const PlannedTile& tile, const std::string& warp_file, double gamma);
/// The file's content.
std::string warp_text(const geom::Warp& warp);

}  // namespace wall::calibrate
