// SPDX-License-Identifier: MIT
// What a session may have of a node: walld says it with the ticket (`wallctl weight`, [quota] of wall.toml). Any
// thread.
#pragma once

#include <chrono>
#include <cstdint>

#include "tileserver/objects/object.h"

namespace wall::tileserver {

struct SessionQuota {
    double weight = 1;                                     ///< turns that it gets where others get one
    std::uint64_t most_bytes = kMaxObjectBytes;            ///< of the driver's memory for its objects, by estimate
    std::uint64_t most_objects = kMaxObjects;              ///< at once
    std::uint64_t bytes_per_second = 0;                    ///< that are read from its stream; 0: as they come
    std::chrono::steady_clock::duration frame_interval{};  ///< from one frame of a window to the next, at least
};

}  // namespace wall::tileserver
