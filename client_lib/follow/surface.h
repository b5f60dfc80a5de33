// SPDX-License-Identifier: MIT
// One GLX drawable or EGL surface of the process, and how its frames come along. The session's mutex guards it once the
// session knows it.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <unordered_map>

#include "client_lib/follow/copy_habit.h"
#include "client_lib/follow/deal.h"
#include "client_lib/follow/surface_options.h"
#include "client_lib/follow/view_use.h"
#include "client_lib/geometry/target_layers.h"
#include "client_lib/link/control_messages.h"
#include "common/base/ids.h"

namespace wall::client {

struct HiddenPart;  // hidden_part.h

/// Of a window: in a parallel program the same in all members, which open their windows in the same order; 0: too many.
SurfaceId next_window_id();

/// Whether every node draws all of a window: one node alone does so anyway, and of a parallel program's none can.
enum class Wholeness : std::uint8_t { is, may_be, cannot_be };

class ClientSurface {
public:
    ClientSurface(SurfaceId own_id, SurfaceOptions own_options);
    ~ClientSurface();
    const SurfaceId id;
    const SurfaceOptions options;
    SurfaceLayout layout;
    std::uint32_t frame = 0;             ///< of the last swap
    bool opened = false;                 ///< walld knows it
    std::optional<bool> srgb;            ///< GL_FRAMEBUFFER_SRGB counts; none: it was never current
    bool whole = false;                  ///< every node draws all of it, and tiles show parts of that
    bool drawn = false;                  ///< something was drawn since the last swap
    Tiles tiles;                         ///< among which it lies; none: it was placed nowhere yet
    std::optional<Placement> next;       ///< from walld, for a frame that begins
    bool cleared = false;                ///< all of its back buffer, since the last swap
    bool content_wanted = false;         ///< by nodes that have seen no frame of it, if it is drawn over
    bool depth_images = false;           ///< depth or stencil was drawn as an image
    CopyHabit copies;                    ///< out of it
    Deal deal;                           ///< of its geometry to nodes
    ViewUse views;                       ///< whether tiles that look elsewhere show what is there
    std::optional<Stereo> stereo;        ///< as the last placement has it
    std::unique_ptr<HiddenPart> hidden;  ///< what no tile shows; null: nothing
    // In a parallel program.
    std::deque<Placement> coming;  ///< for frames that have not begun, in order
    Extent window;                 ///< of this process's own window, as walld was told
};

/// Those that the session knows, by id.
using OpenSurfaces = std::unordered_map<SurfaceId, ClientSurface*>;

}  // namespace wall::client
