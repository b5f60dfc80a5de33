// SPDX-License-Identifier: MIT
// The session's surfaces: told to walld and to nodes, and where each lies. A placement is adopted only between two
// frames, so that none mixes two layouts; in a parallel program at the frame that walld names, as in all its members.
// Application threads; the session's mutex is held.
#pragma once

#include <optional>
#include <vector>

#include "client_lib/follow/hidden_parts.h"
#include "client_lib/follow/nodes.h"
#include "client_lib/follow/surface.h"
#include "client_lib/link/control.h"
#include "client_lib/link/parallel.h"

namespace wall::client {

class Surfaces {
public:
    /// All that it is given outlives it. `open`: those that it knows.
    Surfaces(ControlLink& control, Nodes& nodes, HiddenParts& hidden, OpenSurfaces& open)
        : control_(control), nodes_(nodes), hidden_(hidden), open_(open) {}

    /// Tells walld, and waits for its placement. A parallel program's comes with take().
    void open(ClientSurface& surface);
    void close(ClientSurface& surface);
    /// A placement from walld, for a frame to come.
    void take(const Placement& placement);
    /// Adopts what came, where a frame begins; also the window's size.
    void begin_frame(ClientSurface& surface);
    Wholeness wholeness(const ClientSurface& surface) const;
    /// Every node has all of its pixels, at the window's own resolution.
    bool everywhere(const ClientSurface& surface) const;
    /// Every node draws all of it from now on; it may be so.
    void draw_whole(ClientSurface& surface);
    /// The same for surfaces that are between two frames.
    void adopt_placements();
    /// Among the tiles of another wall, which waits until walld has said where.
    void place_anew();
    /// Whether any of them is being drawn.
    bool in_frame() const;
    /// A node came or went: pixel buffers whose node is gone go to another one, and so do those that had none; so do
    /// the hidden parts of windows.
    void place_off_wall();
    /// Programs that draw only when asked are asked.
    void ask_to_redraw();

    /// Whether all members of a parallel program draw into it.
    bool common(const ClientSurface& surface) const { return group_ && surface.options.visible; }

private:
    void lay_whole(ClientSurface& surface);
    void look_otherwise(ClientSurface& surface);
    void lay_recorded(ClientSurface& surface);
    bool recorded_otherwise(const ClientSurface& surface) const;
    void lay_hidden(ClientSurface& surface);
    void take_place(ClientSurface& surface, const Placement& placement);
    void apply_layout(ClientSurface& surface, const Placement& placement);
    void adopt_placement(ClientSurface& surface);
    void adopt_agreed(ClientSurface& surface);
    void follow_window(ClientSurface& surface);
    void report_window(ClientSurface& surface);

    const std::optional<Parallel>& group_ = parallel();
    ControlLink& control_;
    Nodes& nodes_;
    HiddenParts& hidden_;
    OpenSurfaces& open_;
};

}  // namespace wall::client
