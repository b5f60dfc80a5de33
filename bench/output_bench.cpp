// SPDX-License-Identifier: MIT
// What it costs to show a tile of 1080p (docs/walls.md): composing one full window, then the output pass with each of
// its steps. "as it is" is the composing alone, which every line has, and twice where two eyes see a picture each; the
// driver has finished at the end of each.
#include <benchmark/benchmark.h>

#include <functional>
#include <memory>

#include "bench/render_side.h"
#include "tileserver/render/compositor.h"

namespace wall::tileserver {
namespace {

using namespace bench;

constexpr geom::Rect kTile{0, 0, 1920, 1080};
constexpr std::uint32_t kSlot = 0, kRightSlot = 1;  ///< the latter of the other eye, where an output shows both

/// A mesh that bends the picture a little.
geom::Warp bent(std::uint32_t columns, std::uint32_t rows) {
    geom::Warp out{.columns = columns, .rows = rows};
    for (std::uint32_t row = 0; row < rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            const float x = static_cast<float>(column) / static_cast<float>(columns - 1);
            const float y = static_cast<float>(row) / static_cast<float>(rows - 1);
            out.points.push_back({x, y + 0.1f * x * (1 - x)});
        }
    }
    return out;
}

using Change = std::function<void(geom::TileOutput&)>;

void blend(geom::TileOutput& output) { output.blend = geom::Blend{.ramps = {200, 200, 0, 0}}; }
void color(geom::TileOutput& output) {
    output.color.emplace();
    output.color->matrix[1] = 0.02f;
    output.color->curves.fill({0, 0.45f, 1});
}
void mesh(geom::TileOutput& output) { output.warp = std::make_shared<const geom::Warp>(bent(33, 19)); }

/// One value for each pixel of the output, as calibration systems write them.
geom::LightMap::Map map_of(std::uint32_t channels, std::uint8_t least) {
    geom::LightMap::Map out{
        static_cast<std::uint32_t>(kTile.width), static_cast<std::uint32_t>(kTile.height), channels, {}};
    out.values.resize(std::size_t{out.width} * out.height * channels);
    for (std::size_t i = 0; i < out.values.size(); ++i)
        out.values[i] = static_cast<std::uint8_t>(least + i / channels % out.width * (255u - least) / out.width);
    return out;
}
geom::LightMap alpha() { return {.share = map_of(1, 40), .lift = {}}; }
geom::LightMap alpha_and_beta() { return {.share = map_of(3, 40), .lift = map_of(3, 0)}; }
Change light(geom::LightMap map) {
    return [map = std::make_shared<const geom::LightMap>(std::move(map))](geom::TileOutput& o) { o.light = map; };
}
Change both_eyes(geom::StereoLayout layout) {
    return [layout](geom::TileOutput& o) {
        o.stereo = layout;
        o.right_slot = kRightSlot;
    };
}

void show(benchmark::State& state, const Change& change) {
    Node node(To::llvmpipe);
    Client client(node, SessionId(1));
    auto output = geom::plain_output(kTile);
    change(output);
    node.node().tiles = {
        {kSlot, kTile, geom::is_plain(output, kTile) ? nullptr : std::make_shared<const geom::TileOutput>(output)}};
    if (output.stereo != geom::StereoLayout::none) node.node().tiles.push_back({kRightSlot, kTile, nullptr});
    node.node().present_at_once = true;
    wire::PackBuffer buffer;
    glapi::pack::SurfacePlace(buffer, SurfaceId(1), 2, kTile.width, kTile.height, 0, 0, kTile.width, kTile.height, 0);
    glapi::pack::Swap(buffer, SurfaceId(1), 1);
    client.run(ContextId(1), buffer);
    Compositor compositor(node.node(), [&](const StackEntry&) { return client.session.surface(SurfaceId(1)); });
    compositor.set_stacking({{SessionId(1), SurfaceId(1)}});
    const auto draw = [&] {
        ++node.node().damage;
        const auto picture = compositor.output(kSlot);
        WALL_ASSERT(picture && picture->width == output.width);
        node.gl().Finish();
    };
    draw();  // compiles
    for (auto _ : state) draw();
}

const bool registered = [] {
    const std::vector<std::pair<const char*, Change>> lines{
        {"as it is", [](geom::TileOutput&) {}},
        {"turned by 180", [](geom::TileOutput& o) { o.rotation = 180; }},
        {"turned by 90",
         [](geom::TileOutput& o) {
             o.rotation = 90;
             std::swap(o.width, o.height);
         }},
        {"enlarged to 2880x1620",
         [](geom::TileOutput& o) {
             o.width = 2880;
             o.height = 1620;
         }},
        {"reduced to 1280x720",
         [](geom::TileOutput& o) {
             o.width = 1280;
             o.height = 720;
         }},
        {"homography",
         [](geom::TileOutput& o) {
             o.warp = std::make_shared<const geom::Warp>(geom::Warp{.homography = {1, 0.02f, 0, 0, 1, 0, 0.05f, 0, 1}});
         }},
        {"mesh of 33x19", mesh},
        {"blend", blend},
        {"color", color},
        {"light map, one value a pixel", light(alpha())},
        {"light maps, share and lift of each colour", light(alpha_and_beta())},
        {"mesh and light maps",
         [maps = light(alpha_and_beta())](geom::TileOutput& o) {
             mesh(o);
             maps(o);
         }},
        {"both eyes side by side", both_eyes(geom::StereoLayout::side_by_side)},
        {"both eyes over and under", both_eyes(geom::StereoLayout::over_under)},
        {"both eyes in rows", both_eyes(geom::StereoLayout::rows)},
        {"both eyes as anaglyph", both_eyes(geom::StereoLayout::anaglyph)},
        {"mesh, blend and color",
         [](geom::TileOutput& o) {
             mesh(o);
             blend(o);
             color(o);
         }},
    };
    for (const auto& [name, change] : lines)
        benchmark::RegisterBenchmark(name, show, change)->Unit(benchmark::kMillisecond)->UseRealTime();
    return true;
}();

}  // namespace
}  // namespace wall::tileserver
