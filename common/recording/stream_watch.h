// SPDX-License-Identifier: MIT
// What a recorder and a recovering reader want to know of a program's stream as it goes by: its frames, its windows,
// and where it begins again. Pure; one thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/result.h"
#include "common/recording/format.h"

namespace wall::recording {

class StreamWatch {
public:
    struct Seen {
        bool begins_again = false;  ///< behind this batch
        /// Frames that end in it, in order.
        struct Swap {
            SurfaceId surface;
            std::uint32_t frame;
        };
        std::vector<Swap> swaps;
    };

    /// A batch's payload (common/wire/batch.h), or why it is none.
    Result<Seen> look(std::span<const std::byte> payload);
    std::uint64_t frames() const { return frames_; }
    const std::vector<Window>& windows() const { return windows_; }

private:
    std::uint64_t frames_ = 0;
    std::vector<Window> windows_;
};

}  // namespace wall::recording
