// SPDX-License-Identifier: MIT
// What wall.toml says (load_config.h reads it): the one description of a wall, for walld and every tileserver.
// docs/operation.md documents the keys. Pure; any thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/trusted_server.h"
#include "common/config/people.h"
#include "common/config/quota.h"
#include "common/geom/rect.h"
#include "common/geom/tile_output.h"
#include "common/geom/view.h"
#include "common/net/address.h"

namespace wall::config {

enum class Backend { egl, osmesa };
const char* name_of(Backend backend);

/// Whether a node changes the order of triangles where nobody sees it (docs/vertex-data.md, "Order").
enum class TriangleOrder { automatic, on, off };

/// A window that shows a tile, on an X display of the node's machine.
struct WindowConfig {
    std::string display;  ///< such as ":0"; empty: DISPLAY in the tileserver's environment
    std::string monitor;  ///< RandR's name of the one that the window covers; empty: of the tile's size, at `x`, `y`
    std::int32_t x = 0, y = 0;  ///< pixels of the X screen, or of `parent`
    std::uint32_t parent = 0;   ///< the X window that it lies in; 0: it is a window of its own
    bool operator==(const WindowConfig&) const = default;
};

/// What a monitor shows.
struct ModeConfig {
    std::int32_t width = 0, height = 0;  ///< pixels
    std::uint32_t millihertz = 0;        ///< pictures in 1000 seconds; 0: any
    bool operator==(const ModeConfig&) const = default;
};

/// A monitor that shows a tile without a window system, by the kernel's mode setting (docs/outputs.md).
struct KmsConfig {
    std::string connector;           ///< such as "DP-1"; empty: the next one with a monitor that no tile names
    std::optional<ModeConfig> mode;  ///< none: that which the monitor likes best
    bool operator==(const KmsConfig&) const = default;
};

struct TileConfig {
    std::string name;                    ///< unique on the wall
    std::uint32_t slot = 0;              ///< its bit in tile masks; no other tile of its tileserver has that
    geom::Rect rect;                     ///< on the canvas
    std::optional<WindowConfig> window;  ///< none: it is no window of an X server
    std::optional<KmsConfig> kms;        ///< none, and no window either: headless
    geom::TileOutput output;             ///< how that shows it; the warp comes with load_warps()
    std::string warp_file;               ///< as wall.toml names it; empty: none
    std::string mpcdi_file;              ///< the same
    std::string gpu = "auto";            ///< or a number, or a PCI address
    bool dealt = false;                  ///< wall.toml does not say which of several GPUs draws it
    bool arriving = false;               ///< it is drawn there, and another node still shows it
    std::optional<geom::View> view;      ///< where it looks; none: it is a part of the canvas as the others
    geom::Eye eye = geom::Eye::both;     ///< that sees it
    bool operator==(const TileConfig&) const = default;
};
/// `headless`, `window` or `kms`, as in wall.toml, without the connector.
const char* output_name(const TileConfig& tile);
/// Nothing but what watches it shows it.
inline bool is_headless(const TileConfig& tile) { return !tile.window && !tile.kms; }

/// What one process draws: the tiles of a [[node]], or those that one of its GPUs draws if there are several.
/// What a node may do for programs whose geometry is dealt to nodes (docs/sort-last.md): draw for others, show.
struct Roles {
    bool render = true, display = true, compose = false;
    bool operator==(const Roles&) const = default;
};

struct NodeConfig {
    std::string name;
    Backend backend = Backend::egl;
    net::Address listen;  ///< data streams
    std::vector<TileConfig> tiles;
    std::string process{};   ///< the [[node]]'s name, of the tileserver that it is a part of
    std::uint16_t part = 0;  ///< number among the nodes of that
    TriangleOrder triangle_order = TriangleOrder::automatic;
    Roles roles{};
    std::string partial_codec = "lz4";  ///< of what it draws for nodes of other machines
    /// That draws its tiles: it is the same for all.
    std::string gpu() const { return tiles.empty() ? "auto" : tiles.front().gpu; }
    /// Null: it has none there.
    const TileConfig* tile(std::uint32_t slot) const;
    bool operator==(const NodeConfig&) const = default;
};
/// A process that was started for one of them can go on as the other: tiles may come, go and lie elsewhere, and outputs
/// show them otherwise, but windows and monitors stay what they were opened as.
bool draws_as(const NodeConfig& a, const NodeConfig& b);
/// Programs draw the same for both: the same tiles at the same places, seen in the same way.
bool same_tiles(const NodeConfig& a, const NodeConfig& b);

struct WallConfig {
    std::string name;
    geom::Vec3 eye{};                          ///< of the person, metres, in the room of the tiles' screens
    std::uint32_t background = 0;              ///< 0xRRGGBB behind all windows
    std::vector<net::Address> control_listen;  ///< walld's; nodes connect to the first
    std::string daemon_user = kWallUser;       ///< walld's, for the nodes: a name or number, "*" for anybody
    PeopleConfig people;                       ///< who may do what
    QuotaConfig quota;                         ///< and have how much
    std::vector<net::Address> http_listen;     ///< none: no HTTP; over TLS where other machines reach it
    std::chrono::milliseconds swap_timeout{250};
    bool sort_last_measured = false;  ///< geometry of all programs may be dealt to nodes, where that is faster
    float lossy_pixels = 0;           ///< how far programs' vertices may lie from where they belong, pixels of the wall
    std::chrono::milliseconds close_timeout{
        3000};                         ///< a program that was asked to close and has not by then is cut off
    std::uint32_t max_sessions = 256;  ///< programs on the wall at once
    std::string state_directory;       ///< for saved layouts; empty: where systemd says, else none
    std::vector<NodeConfig> nodes;     ///< node index = index

    /// The least rectangle from (0,0) that holds every tile.
    geom::Rect canvas() const;
    const NodeConfig* find_node(std::string_view node) const;
    /// Those that the tileserver `process` is; none: there is no such [[node]].
    std::vector<NodeConfig> nodes_of(std::string_view process) const;
};

}  // namespace wall::config
