// SPDX-License-Identifier: MIT
// A sync object (OpenGL 3.2, 5.3): a fence that the contexts of a share group know by a handle.
#pragma once

#include <atomic>
#include <string>

#include "client_lib/follow/fence.h"

namespace wall::client {

struct FenceObject {
    Fence fence;
    std::atomic<bool> signaled{false};  ///< stays
    std::string label;                  ///< guarded by the share group's mutex
};

}  // namespace wall::client
