// SPDX-License-Identifier: MIT
// The description in an MPCDI file (VESA, "Multiple Projection Common Data Interchange", 1.0; 2.0 has the same for what
// is read here): its regions, one for each projector. Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/geom/view.h"

namespace wall::mpcdi {

enum class Profile {
    media,       ///< "2d": pixels of the projector look at places of the region
    simulation,  ///< "3d": the same, of a region that is seen by a camera
    surface,     ///< "a3": they look at places in the room
    lamps,       ///< "sl": they look at places of objects in the room
};
const char* name_of(Profile profile);

/// Degrees; to the right, up, and clockwise as seen. Edges are to the right and up of the middle.
struct Frustum {
    double yaw = 0, pitch = 0, roll = 0, left = 0, right = 0, down = 0, up = 0;
};

/// The unit vectors of the room's coordinates about which one turns: down, to the right, ahead.
struct Axes {
    geom::Vec3 yaw{0, -1, 0}, pitch{1, 0, 0}, roll{0, 0, -1};
};

/// A map of light: where it is, and the gamma that its values are to.
struct LightFile {
    std::string path;
    double gamma = 1;
};

struct Region {
    std::string id;
    std::int32_t width = 0, height = 0;  ///< pixels of the projector
    std::optional<Frustum> frustum;      ///< of "3d" always
    Axes axes;
    std::string warp;   ///< its file; empty: none
    double metres = 1;  ///< that a unit of it is, of "a3" and "sl"
    std::optional<LightFile> alpha, beta;
};

struct Setup {
    Profile profile = Profile::media;
    std::vector<Region> regions;
};

/// Reads it; the error begins with `name` and the line.
Result<Setup> parse_setup(std::string_view xml, const std::string& name);

}  // namespace wall::mpcdi
