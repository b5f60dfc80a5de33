// SPDX-License-Identifier: MIT
// What the client library says it implements: the one place. glGetString says less where a node can do less.
#pragma once

#include <span>

namespace wall::client {

inline constexpr int kGlMajor = 1, kGlMinor = 5;
inline constexpr const char* kWallVersion = "WallGL 0.1";

/// Extensions whose every command and word is implemented here. Those that only promise something of the driver are
/// offered where all nodes have them.
struct Extension {
    const char* name;
    bool needs_node;
};
std::span<const Extension> implemented_extensions();

}  // namespace wall::client
