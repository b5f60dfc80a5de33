// SPDX-License-Identifier: MIT
// How a tile's output - a monitor, a projector - shows its part of the canvas: turned, with other pixels, warped, faded
// where it overlaps its neighbours, in corrected colours. docs/walls.md has the formulas. Pure.
//
//   pixel of the output --(warp)--> place on the flat output --(rotation)--> place in the tile --> pixels of the canvas
//
// Places are fractions: (0, 0) is the top left corner of the first pixel, (1, 1) the bottom right corner of the last.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "common/geom/rect.h"

namespace wall::geom {

inline constexpr std::int32_t kMaxOutputExtent = 16384;     ///< pixels a side
inline constexpr std::uint32_t kMaxMeshPoints = 256 * 256;  ///< of a warp
inline constexpr std::uint32_t kMaxCurvePoints = 256;       ///< of a tone curve

struct Point {
    float x = 0, y = 0;
    bool operator==(const Point&) const = default;
};

/// Where each place of an output looks: a homography, or a mesh. What it says beyond 0 to 1 is black.
struct Warp {
    /// Row by row; (x, y, 1) of the output gives (x', y', w'), the place is (x' / w', y' / w').
    std::array<float, 9> homography{1, 0, 0, 0, 1, 0, 0, 0, 1};
    /// A grid of columns x rows points that covers the output from corner to corner, row by row; between them as they
    /// say, linearly along both sides of a cell. Cells with a point that is NaN are black. 0: the homography holds.
    std::uint32_t columns = 0, rows = 0;
    std::vector<Point> points;
    bool operator==(const Warp&) const = default;
};

/// Why it cannot be shown; nullptr: it can. Everything is finite, no point of the output lies at infinity, and no two
/// parts of it look at one place because it is folded. (Mirrored as a whole it may be: projectors behind a screen.)
const char* wrong_with(const Warp& warp);

/// What is shown less bright at a tile's edges because another projector shows it, too.
struct Blend {
    enum Edge : std::uint8_t { left, right, top, bottom };
    std::array<float, 4> ramps{};  ///< by Edge, pixels of the canvas; 0: none
    float gamma = 2.2f;            ///< of the projector: light = value ^ gamma
    /// Light of black as the projector shows it, of its white. What only one shows is lifted to what several do.
    float black = 0;
    bool operator==(const Blend&) const = default;
};

/// How much of its picture each place of an output shows, as a map: values times `share`, and up to white as `lift`
/// says where a projector alone would be darker than several. Both cover the output from edge to edge, row by row.
struct LightMap {
    struct Map {
        std::uint32_t width = 0, height = 0;  ///< places; 0: there is none
        std::uint32_t channels = 1;           ///< 3: red, green and blue each
        std::vector<std::uint8_t> values;     ///< 255: all
        bool operator==(const Map&) const = default;
    };
    Map share, lift;
    bool operator==(const LightMap&) const = default;
};

/// Why it cannot be shown; nullptr: it can.
const char* wrong_with(const LightMap& light);

/// Brings an output's colours to those of the others.
struct ColorCorrection {
    using Curve = std::vector<float>;  ///< values 0 to 1 at equal steps from 0 to 1, linear between; empty: none
    std::array<float, 9> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row by row, of red, green and blue light
    float gamma = 2.2f;                                      ///< what makes values into light for that
    std::array<Curve, 3> curves;                             ///< of red, green and blue values, after all else
    bool operator==(const ColorCorrection&) const = default;
};

/// How one output shows the pictures of two eyes.
enum class StereoLayout : std::uint8_t {
    none,          ///< it does not
    side_by_side,  ///< the left half is the left eye's, each half as wide as the whole is
    over_under,    ///< the upper half is the left eye's
    rows,          ///< rows 0, 2, ... are the left eye's
    anaglyph,      ///< red is the left eye's, green and blue are the right one's
};
/// As in wall.toml; "" for none.
const char* name_of(StereoLayout layout);

struct TileOutput {
    /// Degrees that the monitor is turned clockwise, as seen from in front of it: 0, 90, 180, 270.
    std::uint32_t rotation = 0;
    std::int32_t width = 0, height = 0;  ///< pixels, as the monitor itself counts them
    std::shared_ptr<const Warp> warp;    ///< none: flat
    std::optional<Blend> blend;
    std::shared_ptr<const LightMap> light;  ///< none: all of it everywhere
    std::optional<ColorCorrection> color;
    StereoLayout stereo = StereoLayout::none;
    std::uint32_t right_slot = 0;              ///< whose picture the right eye sees, if there are two
    bool operator==(const TileOutput&) const;  ///< of what warp and light say
};

/// Of a tile that is shown pixel for pixel.
TileOutput plain_output(const Rect& tile);
bool is_sideways(std::uint32_t rotation);
/// Nothing has to be done to the canvas's pixels.
bool is_plain(const TileOutput& output, const Rect& tile);

/// From a place of the output to one of the tile. The specification of what GPUs do.
Point place_in_tile(const TileOutput& output, Point of_output);

}  // namespace wall::geom
