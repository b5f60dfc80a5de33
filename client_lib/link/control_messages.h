// SPDX-License-Identifier: MIT
// The client's part of proto/control.proto as plain structs, written and read with protozero (header only:
// libprotobuf's symbols would clash with the application's). Pure; any thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "client_lib/link/parallel.h"
#include "client_lib/link/window_messages.h"
#include "client_lib/process/traffic.h"
#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/base/stereo.h"
#include "common/geom/rect.h"
#include "common/geom/view.h"

namespace wall::client {

/// A session that the program had with a walld that is gone. Its streams to the nodes may still be open.
struct Resume {
    SessionId session;
    std::map<NodeIndex, std::string> tickets;
    std::uint32_t windows = 0;  ///< that will be announced with a Restore
};

/// What a program says of itself when it comes to the wall.
struct Hello {
    std::uint32_t pid = 0;
    std::string program;                ///< the program's name, for people
    std::string name;                   ///< WALLGL_NAME
    std::optional<geom::Rect> rect;     ///< WALLGL_RECT; nothing: where there is room, 1:1
    bool fullscreen = false;            ///< WALLGL_RECT=fullscreen
    bool hold = false;                  ///< WALLGL_HOLD
    std::optional<Stereo> stereo;       ///< WALLGL_STEREO
    bool sort_last = false;             ///< WALLGL_SORT_LAST
    std::optional<float> lossy_pixels;  ///< WALLGL_LOSSY_PIXELS
    std::string token;                  ///< from WALLGL_TOKEN_FILE: who owns the session, if not the Unix user
    std::optional<Parallel> group;      ///< from WALLGL_PARALLEL
    std::optional<Resume> resume;       ///< it was on the wall before
    std::string invalid;                ///< what is wrong in the environment; ControlLink::open fails with it

    /// Of this process, from its name and the environment.
    static Hello from_environment();
};

/// What all nodes of the wall can do: glGetString and glGet values.
struct Caps {
    std::string vendor, renderer, version, shading_language_version;
    std::string extensions;                                         ///< separated by blanks
    std::unordered_map<std::uint32_t, std::vector<double>> limits;  ///< by GL enum
};

struct NodeInfo {
    NodeIndex node;                 ///< the same as long as walld runs
    std::string address;            ///< unix:PATH or HOST:PORT
    std::string ticket;             ///< bytes, for DataHello
    std::uint32_t incarnation = 0;  ///< grows when the node's process is a new one
    bool up = true;                 ///< false: only `node` means anything
    bool records = false;           ///< it keeps in a file what comes: it shows nothing and answers nothing
    bool renders = false;           ///< of a sort-last session: it may draw what other nodes show
    bool composes = false;          ///< of a sort-last session: it may compose what other nodes draw
    bool hands_on = false;          ///< what goes to several such nodes may go to one of them, which hands it on
};

struct TileInfo {
    NodeIndex node;
    std::uint32_t slot = 0;
    geom::Rect rect;  ///< canvas
    std::string name;
    std::optional<geom::View> view;  ///< none: it shows its part of the canvas
    geom::Eye eye = geom::Eye::both;
};

/// The tiles of the wall at some time. Many placements share them.
using Tiles = std::shared_ptr<const std::vector<TileInfo>>;

struct Welcome {
    SessionId session;
    std::uint32_t canvas_width = 0, canvas_height = 0;
    std::vector<TileInfo> tiles;
    std::vector<NodeInfo> nodes;
    Caps caps;
    std::uint32_t swap_timeout_ms = 250;
    float lossy_pixels = 0;           ///< how far vertices may lie from where they belong, pixels of the wall
    bool sort_last_measured = false;  ///< geometry may be dealt to nodes where that is measured to be faster
};

struct Refused {
    std::string reason;
    bool over = false;  ///< the session that was to go on does not, and never will
};

/// The surface's whole content covers `rect` of the canvas.
struct Placement {
    SurfaceId surface;
    std::uint32_t layout_version = 0;
    geom::Rect rect;
    Tiles tiles;                   ///< among which it lies; the link adds them, from what walld said last
    std::optional<Stereo> stereo;  ///< none: tiles of both eyes show the same
    // To a parallel program.
    std::uint32_t from_frame = 0;         ///< it holds from this frame on
    std::uint32_t width = 0, height = 0;  ///< of the window, in every member
    std::vector<NodeInfo> nodes;          ///< of the session
    bool agreed = false;                  ///< by all processes; else proposed
};

/// The placement that was proposed holds.
struct PlacementAgreed {
    SurfaceId surface;
    std::uint32_t layout_version = 0;
};

/// walld knows from which frame on a placement holds.
struct AdoptionNoted {
    SurfaceId surface;
    std::uint32_t layout_version = 0;
};

/// walld's own, for the walld that comes after it: kept with the surface, and not looked at.
struct SurfaceNote {
    SurfaceId surface;
    std::string note;
};

/// Where a surface is that an earlier walld knew.
struct Restore {
    geom::Rect drawn, wanted;          ///< canvas: of the frames that come now, and of the newest placement
    std::uint32_t wanted_version = 0;  ///< of a parallel program
    std::string note;
    std::vector<Placement> agreed;  ///< of a parallel program: the last ones
};

/// Placements that come from now on lie among these.
struct TilesChanged {
    std::vector<TileInfo> tiles;
};

struct CloseRequest {
    SurfaceId surface;
    std::string reason;
};

/// An operator wants the program on another wall.
struct MoveRequest {
    std::string address;  ///< unix:PATH
};

/// A window that walld is told of.
struct OpenWindow {
    std::uint32_t width = 0, height = 0;  ///< pixels
    std::string title;
    std::optional<NativeWindow> native;
};

/// A message from walld; nothing for one that this version does not know.
using FromWalld = std::variant<std::monostate, Welcome, Refused, Placement, NodeInfo, CloseRequest, AdoptionNoted,
                               SurfaceNote, TilesChanged, PlacementAgreed, MoveRequest>;

// One encoded Envelope each, without the length in front.
std::string encode(const Hello& hello);
std::string encode_surface_open(SurfaceId id, const OpenWindow& window, const std::optional<Restore>& restore = {});
/// Asks walld for a sign of life.
std::string encode_ping();
std::string encode_surface_resize(SurfaceId id, std::uint32_t width, std::uint32_t height);
std::string encode_surface_close(SurfaceId id);
std::string encode_surface_adopted(SurfaceId id, std::uint32_t layout_version, std::uint32_t frame);
std::string encode_close_refused(SurfaceId id);
/// `refused`: why the program stays; empty: it has moved.
std::string encode_move_answer(std::string_view refused);
std::string encode(const Traffic& traffic);
/// `begun`: the frame of that surface that has begun and is too late for the placement; 0: it is not.
std::string encode_placement_noted(SurfaceId id, std::uint32_t layout_version, std::uint32_t begun);
std::string encode_member_leaves(std::uint32_t rank);

Result<FromWalld> decode_from_walld(std::string_view envelope);

/// The first message on a data stream, for NodeStream::open.
std::string encode_data_hello(SessionId session, std::string_view ticket, std::uint32_t rank);
/// What is appended to it to go on with a stream of which so many frames have come. `attempt`: more than of any before.
std::string encode_resume(std::uint32_t stream, std::uint64_t received, std::uint64_t attempt);

}  // namespace wall::client
