// SPDX-License-Identifier: MIT
// The sink of diff() on the client: every changed value becomes a command of the stream.
#pragma once

#include "common/glstate/value_history.h"
#include "gen/glapi/wire.gen.h"
#include "gen/glstate/state.gen.h"

namespace wall::glstate {

/// Small values and matrices that come back take 5 bytes (`StateSmall`, `StateRecall`). `history` is the follower's.
struct PackSink {
    wire::PackBuffer& to;
    ValueHistory& history;
    template <class E>
    void set(unsigned i, const typename E::type& v) {
        const std::uint32_t id = E::id + i;
        if constexpr (sizeof v == ValueHistory::kValueBytes) {
            if (const auto place = history.find(id, &v)) {
                history.recall(id, *place);
                return glapi::pack::StateRecall(to, id | *place << 16);
            }
            history.add(id, &v);
        } else if constexpr (sizeof v == sizeof(std::uint32_t)) {
            std::uint32_t word;
            std::memcpy(&word, &v, sizeof word);
            if (word <= 0xffff) return glapi::pack::StateSmall(to, id | word << 16);
        }
        glapi::pack_state(to, id, &v, sizeof v);
    }
};

}  // namespace wall::glstate
