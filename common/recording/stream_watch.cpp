// SPDX-License-Identifier: MIT
#include "common/recording/stream_watch.h"

#include <algorithm>

#include "common/glstate/command_walk.h"
#include "common/wire/batch.h"

namespace wall::recording {

using glapi::Op;

Result<StreamWatch::Seen> StreamWatch::look(std::span<const std::byte> payload) {
    const auto batch = wire::split_batch(payload);
    if (!batch) return tl::unexpected(batch.error());
    Seen seen;
    glstate::CommandWalk walk(batch->opcodes, batch->operands);
    for (;;) {
        const auto command = walk.next();
        if (!command) return tl::unexpected(command.error());
        if (!*command) return seen;
        const glstate::Command& now = **command;
        seen.begins_again = now.op == Op::BeginAgain;
        if (now.op == Op::Swap) {
            seen.swaps.push_back({SurfaceId(now.word(0)), now.word(1)});
            ++frames_;
        } else if (now.op == Op::SurfacePlace) {
            const Window window{SurfaceId(now.word(0)), now.word(2), now.word(3)};
            const auto known = std::ranges::find(windows_, window.surface, &Window::surface);
            if (known != windows_.end()) *known = window;
            else if (windows_.size() < kMostWindows) windows_.push_back(window);
        }
    }
}

}  // namespace wall::recording
