// SPDX-License-Identifier: MIT
// When vertices are sent a little off (geometry/snap.h): as far as the wall allows it, or the program asks for less;
// where a link is measured to be slow (link/coding_choice.h) and the stream to become smaller (smaller_choice.h), or
// always if the program asks for it. All nodes of a frame get the same. The session's mutex is held.
//
// The blocks of one transformation may share vertices, and which grid they get depends on whether one of them reaches
// behind the eye. So their vertices are moved in the nodes' batches once all blocks are there: when the transformation
// changes or the frame ends. A batch that must go before that gets the grid that is right in any case, and so does the
// rest of the transformation.
//
// What comes again as it was in the frame before stays where it is: the coder finds it there, which no grid can better.
#pragma once

#include <array>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "client_lib/follow/block_sender.h"
#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/follow/smaller_choice.h"
#include "client_lib/geometry/snap.h"
#include "client_lib/link/parallel.h"
#include "common/glstate/projection.h"

namespace wall::client {

class Snapping {
public:
    /// `asked`: by the program, pixels.
    Snapping(Nodes& nodes, std::optional<float> asked);

    /// By the wall, pixels.
    void allow(float pixels) { allowed_ = pixels; }
    void begin_frame(const ClientSurface& surface);
    /// Before a block is sent, of which all is known. Returns the projection that bounds where it is seen; nothing: its
    /// vertices stay where they are.
    std::optional<glstate::Projection> before_block(const DrawSource& source, Packer& packer,
                                                    const glstate::Projection& projection);
    /// Where the block goes is to be written here; null: nobody wants to know.
    std::vector<PackedPart>* packed() { return holds_ ? &parts_ : nullptr; }
    /// All blocks of the transformation are there.
    void settle();
    void forget(SurfaceId surface) { frames_.erase(surface); }

private:
    struct Frame {
        bool snaps = false;
        float pixels = 0;
        std::unordered_set<std::size_t> blocks, before;  ///< hashes of its blocks, and of the last frame's
    };
    float bound() const;
    bool is_wanted();
    bool repeats() const { return 2 * repeated_ >= bytes_; }
    bool begin_transformation(const glstate::Projection& projection, const ClientSurface& surface, float pixels);
    void count(const Snapped& snapped) const;

    Nodes& nodes_;
    const std::optional<float> asked_;
    float allowed_ = 0;
    SmallerChoice choice_;
    std::unordered_map<SurfaceId, Frame> frames_;

    // Of the transformation of the last block.
    SurfaceId surface_;
    glstate::Mat4 clip_{};
    std::array<float, 6> place_{};  ///< its viewport, and the window's scale on the wall
    std::optional<SnapGrid> grid_;
    float reach_ = 0;                       ///< infinity: the grid that is right in any case
    std::size_t bytes_ = 0, repeated_ = 0;  ///< of its blocks, and of those that came in the last frame, too
    std::optional<bool> exact_;             ///< it stays as it is; none: that is not decided
    bool holds_ = false;                    ///< the last block is one of `parts_`
    std::vector<PackedPart> parts_;
};

}  // namespace wall::client
