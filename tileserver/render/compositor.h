// SPDX-License-Identifier: MIT
// Puts the layers of all sessions together to the picture of a tile, and reads pictures back without waiting for the
// driver. Render thread.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/ids.h"
#include "tileserver/render/output_pass.h"
#include "tileserver/render/picture_budget.h"
#include "tileserver/render/test_pattern.h"
#include "tileserver/session/render_node.h"

namespace wall::tileserver {

struct StackEntry {
    SessionId session;
    SurfaceId surface;
    bool operator==(const StackEntry&) const = default;
};

struct PictureRequest {
    PictureId id;
    bool stream = false;  ///< one of many under that id
    std::uint32_t slot = 0;
    SessionId session;                    ///< only its layers; none: all
    SurfaceId surface;                    ///< only this one of the session; none: all
    geom::Rect crop;                      ///< in pixels of the tile; empty: all of it
    std::uint32_t width = 0, height = 0;  ///< of the picture; 0: the crop's; never more than that
    bool output = false;                  ///< as the tile's output shows it: `crop` is in its pixels
};

struct Picture {
    PictureRequest request;
    std::uint32_t width = 0, height = 0;
    std::vector<std::byte> rgba;       ///< top row first, 4 bytes a pixel, no padding
    std::string error;                 ///< set: there is no picture
    std::shared_ptr<const void> hold;  ///< its share of the PictureBudget, until the last copy of this is gone
};

class Compositor {
public:
    using FindSurface = std::function<const SurfaceReplica*(const StackEntry&)>;  ///< null: no such surface (yet)

    Compositor(RenderNode& node, FindSurface find)
        : node_(node), gl_(node.driver.gl()), find_(std::move(find)), output_pass_(node.driver) {}
    ~Compositor();
    Compositor(const Compositor&) = delete;

    void set_background(std::uint32_t rgb);
    void set_stacking(std::vector<StackEntry> bottom_first);
    /// Instead of the layers; none: these again.
    void set_pattern(std::uint32_t slot, std::shared_ptr<const TestPattern> pattern);
    /// The node has other tiles: nothing is kept of those that it has no more, nor any test picture.
    void tiles_changed();
    /// What the tile's output is to show: all layers, composed now unless they are already. Good until the compositor
    /// is called again. None: this node has no such tile (yet).
    std::optional<PictureTexture> output(std::uint32_t slot);
    /// Starts reading a tile; collect() gives the picture later.
    void request(const PictureRequest& request);
    /// The pictures that have arrived, at most kMostAtOnce. `wait`: all that were requested.
    std::vector<Picture> collect(bool wait);
    bool busy() const { return !readbacks_.empty() || !refused_.empty(); }
    /// No picture should be requested now: too many are on their way.
    bool full() const { return budget_.spent(); }

    static constexpr std::size_t kMostAtOnce = 4;  ///< so that the copying does not hold up the drawing

private:
    struct TileTarget {
        geom::Rect rect;
        GLuint texture = 0, framebuffer = 0;
        std::uint64_t composed = 0;                  // RenderNode::damage that the picture shows; 0: none
        std::uint64_t version = 0;                   // one for each time
        StackEntry only;                             // of one session or surface only
        std::shared_ptr<const TestPattern> pattern;  // that it shows
    };
    struct Readback {
        PictureRequest request;
        std::uint32_t width = 0, height = 0;
        GLuint buffer = 0;
        GLsync done = nullptr;
        std::shared_ptr<const void> hold;
    };
    const Tile* tile(std::uint32_t slot) const;
    TileTarget& target(const Tile& tile);
    void compose(TileTarget& target, std::uint32_t slot, const StackEntry& only);
    /// Scaled to where the window lies.
    void draw_whole(const TileTarget& target, const Layer& layer, const geom::Rect& place);
    void draw_layer(const TileTarget& target, const Layer& layer);
    static PictureTexture as_it_is(const TileTarget& target);
    PictureTexture of_right_eye(const geom::TileOutput& output, const TileTarget& of_left);
    PictureTexture as_output_shows(const Tile& tile, const TileTarget& target);
    TileTarget make_target(const geom::Rect& rect) const;
    TileTarget scaled(const PictureTexture& picture, geom::Rect part, std::int32_t width, std::int32_t height) const;
    void release(TileTarget& target) const;
    void draw_pattern(const TileTarget& target, const TestPattern& pattern) const;
    void read_back(const PictureRequest& request, GLuint framebuffer, const geom::Rect& part);
    Picture finish(const Readback& readback);

    RenderNode& node_;
    const Gl& gl_;
    FindSurface find_;
    std::array<float, 4> background_{0, 0, 0, 1};
    std::vector<StackEntry> stacking_;
    std::map<std::uint32_t, TileTarget> targets_;  // by slot
    GLuint source_ = 0;                            // framebuffer that a layer's texture is read through
    struct Pattern {
        std::shared_ptr<const TestPattern> what;
        TileTarget on_output;  // drawn already, if it is for the output
    };
    std::map<std::uint32_t, Pattern> patterns_;  // by slot
    std::uint64_t compositions_ = 0;
    OutputPass output_pass_;
    bool told_of_failure_ = false;
    PictureBudget budget_;
    std::deque<Readback> readbacks_;
    std::vector<Picture> refused_;
};

}  // namespace wall::tileserver
