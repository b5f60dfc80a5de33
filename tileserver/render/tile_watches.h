// SPDX-License-Identifier: MIT
// When a watched tile is read back: somebody is ready for a picture, it is not too soon, and the tile has changed (or a
// picture is wanted all the same). Whoever is slow delays only their own next picture. Pure; one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <vector>

#include "tileserver/render/compositor.h"

namespace wall::tileserver {

class TileWatches {
public:
    using Clock = std::chrono::steady_clock;

    /// Ready at once. `request.id` names the stream; an earlier one of that name is replaced.
    void add(const PictureRequest& request, std::chrono::microseconds interval);
    void remove(PictureId stream) { watches_.erase(stream); }
    void ready(PictureId stream, bool even_unchanged);

    /// The pictures to take now, at most `most`, those first that could have been taken first; each is taken to be on
    /// its way. `damage`: grows when any tile may have changed.
    std::vector<PictureRequest> due(std::uint64_t damage, Clock::time_point now, std::size_t most);
    /// How long until a picture is due if nothing changes but the time.
    Clock::duration next_due(std::uint64_t damage, Clock::time_point now) const;

private:
    struct Watch {
        PictureRequest request;
        std::chrono::microseconds interval{};
        bool ready = true, even_unchanged = true;
        std::uint64_t shown = 0;  ///< damage at the last picture
        Clock::time_point not_before{};

        bool wants(std::uint64_t damage) const { return ready && (even_unchanged || shown != damage); }
    };
    std::map<PictureId, Watch> watches_;  // by stream
};

}  // namespace wall::tileserver
