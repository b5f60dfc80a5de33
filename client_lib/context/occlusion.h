// SPDX-License-Identifier: MIT
// Occlusion queries of a context (OpenGL 2.1, 4.1.7). The current one is a state element, so that every node knows
// which of its drawing counts; the answer is the sum over the nodes. Application's thread.
#pragma once

#include <memory>

#include "client_lib/objects/share_group.h"

namespace wall::client {

struct OcclusionQuery {
    GLuint name = 0;
    ClientName id;  ///< on the wire; another one for each glBeginQuery
    bool answered = false;
    std::uint64_t samples = 0;
};

struct OcclusionState {
    NameTable<OcclusionQuery> queries;
    std::shared_ptr<OcclusionQuery> current;
};

}  // namespace wall::client
