// SPDX-License-Identifier: MIT
// The part of a window that no tile shows: beyond the wall, behind a bezel, on a node that is gone. A program may read
// it back all the same, and few do. So what is drawn there is kept as packed commands until the frame is over, and only
// when somebody looks is it sent to one node, into a layer of the whole window; from then on the part is drawn like the
// rest, until nobody has looked for a while (docs/off-the-wall.md). The session's mutex guards it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_map>
#include <vector>

#include "client_lib/follow/node.h"
#include "client_lib/geometry/target_layers.h"
#include "client_lib/objects/share_group.h"
#include "common/base/ids.h"
#include "gen/glstate/state.gen.h"

namespace wall::client {

/// More than this is not kept: it is sent, and the part drawn from then on.
inline constexpr std::size_t kMostKeptBytes = std::size_t{64} << 20;
/// The same for frames that build on each other, so that none of them can be forgotten.
inline constexpr std::size_t kMostKeptFrames = 8;
/// Frames in a row in which nobody has looked, after which commands are kept again.
inline constexpr unsigned kQuietFrames = 60;

/// What was drawn between two swaps.
class KeptFrame {
public:
    /// A matrix among the commands: a node remembers it (value_history.h).
    struct Matrix {
        std::uint32_t element = 0;
        std::size_t operand = 0;  ///< where its value begins
    };

    /// Commands of one context in a row.
    struct Stretch {
        ContextId context;
        wire::PackBuffer commands;
        std::vector<Matrix> matrices;
    };
    /// What a context was like before its first command.
    struct Start {
        glstate::State state;
        std::shared_ptr<ShareGroup> share;
    };

    /// Sets the follower to a context: what has been packed for another one is a stretch of its own.
    void turn_to(ContextId context);
    void seal();
    /// Begins anew, with the memory that it has.
    void restart(bool whole);
    bool empty() const { return stretches.empty() && follower.batch.empty(); }
    std::size_t bytes() const { return sealed_bytes_ + follower.batch.bytes(); }

    /// Stands for the node when it has executed the frame; its batch is the stretch being packed.
    Node follower;
    TargetLayer layer;             ///< that the commands are for
    Mirror* mirror = nullptr;      ///< the follower's, of the context that it is set to
    std::vector<Matrix> matrices;  ///< of that stretch
    std::vector<Stretch> stretches;
    std::unordered_map<ContextId, Start> starts;  ///< by context
    ContextId started;                            ///< the last context that was looked for in `starts`
    bool whole = false;                           ///< begins by clearing all that counts

private:
    wire::PackBuffer empty_buffer();

    std::size_t sealed_bytes_ = 0;
    std::vector<wire::PackBuffer> spare_;  ///< what is allocated anew for each frame has to be mapped anew as well
};

struct HiddenPart {
    TargetLayer layer;                    ///< of the whole window; its area is what may be seen of the part
    std::uint32_t width = 0, height = 0;  ///< of the window
    bool everything = false;              ///< no tile shows any of the window
    bool drawn = false;                   ///< like the rest; otherwise its commands are kept
    unsigned quiet = 0;                   ///< frames since somebody looked
    /// Something was drawn by these buffers.
    bool depth_matters = false, stencil_matters = false, accum_matters = false;

    std::deque<KeptFrame> finished;  ///< frames that are over, each but the first building on the one before
    KeptFrame now;

    std::size_t bytes() const;
    bool too_much() const { return bytes() > kMostKeptBytes || finished.size() > kMostKeptFrames; }
    /// The frame is over: those before it are forgotten if it can do without them.
    void finish();
    void forget();
};

/// The smallest rectangle around what `shown` leaves uncovered of `window`; empty: nothing.
geom::Rect uncovered(const geom::Rect& window, const std::vector<geom::Rect>& shown);

}  // namespace wall::client
