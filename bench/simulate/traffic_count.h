// SPDX-License-Identifier: MIT
// What a stream brings to a node, counted without drawing it. Pure; one thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/glstate/command_walk.h"

namespace wall::simulate {

struct Traffic {
    std::uint64_t plain_bytes = 0;  ///< of batches, as they are before coding
    std::uint64_t commands = 0, blocks = 0;
    std::uint64_t vertices = 0;   ///< in blocks and lists called there, and named by draws from arrays
    std::uint64_t in_pieces = 0;  ///< of these, in draws of which the node leaves out what it does not show
    void operator+=(const Traffic& other);
};

/// Of one stream: lists keep what they were defined with.
class TrafficCount {
public:
    struct Seen {
        Traffic traffic;
        struct Swap {
            SurfaceId surface;
            std::uint32_t frame;
        };
        std::vector<Swap> swaps;  ///< the last command of a batch
        struct Question {
            RequestId request;
            std::string name;  ///< of the command
        };
        std::vector<Question> questions;
    };

    /// A batch's payload (common/wire/batch.h), or why it is none.
    Result<Seen> look(std::span<const std::byte> payload);

private:
    Result<void> count(glstate::CommandWalk walk, Seen& seen);
    void count(const glstate::Command& now, Seen& seen);

    std::unordered_map<std::uint32_t, std::uint64_t> run_vertices_;  ///< by the run's name
};

}  // namespace wall::simulate
