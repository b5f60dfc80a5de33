// SPDX-License-Identifier: MIT
// What a region of an MPCDI file is to a tile: a mesh in place of its map of places, factors of light, and where it
// looks. docs/walls.md, "MPCDI". Pure; any thread.
#pragma once

#include <memory>
#include <optional>

#include "common/base/result.h"
#include "common/geom/tile_output.h"
#include "common/geom/view.h"
#include "walld/mpcdi/maps.h"
#include "walld/mpcdi/setup.h"

namespace wall::mpcdi {

/// Where each pixel of a projector looks, as the fractions of a tile that it shows.
struct Look {
    Field places;                    ///< x and y of each; the third number means nothing
    std::optional<geom::View> view;  ///< of the tile; none: it is a part of the canvas
};
/// Of profiles whose maps say it in the picture (2d, 3d), or as places in the room, seen by `eye` (a3, sl: metres; x to
/// the right, y up, z towards the person). The error says what is wrong with the map.
Result<Look> look_of(const Region& region, Profile profile, Field map, const geom::Vec3& eye);

struct Mesh {
    geom::Warp warp;
    float error = 0;  ///< of the farthest place, pixels of the tile
};
/// As coarse as it may be for that it is off by no pixel's `most` of a tile of this size, or the finest that there may
/// be.
Mesh mesh_of(const Field& places, std::int32_t width, std::int32_t height, float most);

/// Of what the projector shows of its region: black where the map says nothing. `gamma`: what the projector makes light
/// of values with. Null: all of it.
std::shared_ptr<const geom::LightMap> light_of(const Field& places, const Factors* alpha, double alpha_gamma,
                                               const Factors* beta, double beta_gamma, double gamma);

}  // namespace wall::mpcdi
