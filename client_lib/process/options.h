// SPDX-License-Identifier: MIT
// The environment variables that change how the client library works, read once (docs/client-library.md lists them).
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace wall::client {

/// Whether what goes to nodes of other machines is coded (common/wire/history_coder.h).
enum class Coding { measured, never, always };

struct Options {
    bool broadcast = false;    ///< WALLGL_BROADCAST=1: everything goes to every node, for comparison
    bool count_ideal = false;  ///< WALLGL_IDEAL=1: also count what perfect sorting by primitive would send
    bool shown_only = false;   ///< WALLGL_SHOWN_ONLY=1: what no tile shows is not kept, and reads back black
    bool ring = true;          ///< WALLGL_RING=0: no shared memory with nodes of this machine, sockets only
    Coding coding =
        Coding::measured;    ///< WALLGL_CODING=0: never, 1: always; else where the link is measured to be slow
    bool sort_last = false;  ///< WALLGL_SORT_LAST=1: geometry may be dealt to nodes (docs/sort-last.md)
    /// WALLGL_LOSSY_PIXELS: how far vertices may lie from where they belong; none: as the wall has it
    std::optional<float> lossy_pixels = {};
    bool drawn_parts = true;  ///< WALLGL_DRAWN_PARTS=0: every node draws all of what is drawn off the window
    bool hand_on = true;      ///< WALLGL_HAND_ON=0: every node gets all that it needs from us (docs/hand-on.md)
    std::vector<std::string> cameras = {};  ///< WALLGL_CAMERA: uniforms that may be a program's camera
};

const Options& options();

}  // namespace wall::client
