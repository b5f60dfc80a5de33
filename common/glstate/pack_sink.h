// SPDX-License-Identifier: MIT
// The sink of diff() on the client: every changed value becomes a `State` command of the stream.
#pragma once

#include "gen/glapi/wire.gen.h"
#include "gen/glstate/state.gen.h"

namespace wall::glstate {

struct PackSink {
    wire::PackBuffer& to;
    template <class E>
    void set(unsigned i, const typename E::type& v) {
        glapi::pack_state(to, E::id + i, &v, sizeof v);
    }
};

}  // namespace wall::glstate
