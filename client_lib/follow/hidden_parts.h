// SPDX-License-Identifier: MIT
// What is done for the parts of windows that no tile shows (hidden_part.h): their commands are kept, and sent when
// somebody looks. The session's mutex is held.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "client_lib/follow/draw_source.h"
#include "client_lib/follow/hidden_part.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/geometry/needs.h"

namespace wall::client {

class HiddenParts {
public:
    /// All that it is given outlives it.
    HiddenParts(Nodes& nodes, const OpenSurfaces& surfaces) : nodes_(nodes), surfaces_(surfaces) {}

    /// Finds the part anew: the window has another place among the tiles, or a node came or went.
    void lay(ClientSurface& surface, std::span<const TileInfo> tiles);

    // ---- keeping ----
    /// What follows a command that is kept; null: it is not (and the draw target's layers may have changed).
    KeptFrame* begin_keeping(const DrawSource& source, const std::optional<PixelRect>& box);
    /// After begin_keeping(): the buffer to pack the command into, behind what it needs.
    wire::PackBuffer& prepare(KeptFrame& frame, const DrawSource& source, const Needs& needs);
    /// A frame is over: before its swap is packed, and after it. `whole`: frames begin with a clear of everything.
    void finish_frame(ClientSurface& surface);
    void note_frame(ClientSurface& surface, bool whole);
    /// The nodes begin again at time zero.
    void forget();

    // ---- before something happens that what is kept may matter to ----
    /// A clear, with glClear's mask.
    void before_clear(const DrawSource& source, std::uint32_t mask);
    /// Pixels of a rectangle are asked for (window pixels, origin bottom left).
    void before_reading(const DrawTarget& target, const geom::Rect& box);
    /// The samples of a query are.
    void before_counting_samples();
    /// glAccum: its buffer goes on from frame to frame.
    void before_accumulating(const DrawTarget& target);
    /// The images of a target made of objects change.
    void before_drawing_to(const DrawSource& source);
    /// A texture, program or run that has been drawn with changes or goes.
    void before_object_changes(ClientName object);
    void before_context_goes(ContextId context);

private:
    std::optional<NodeIndex> node_for(const ClientSurface& surface, std::optional<NodeIndex> before);
    void rest(ClientSurface& surface);
    void show(ClientSurface& surface);
    void send_kept(Node& node, ClientSurface& surface, KeptFrame& frame);

    Nodes& nodes_;
    const OpenSurfaces& surfaces_;
};

}  // namespace wall::client
