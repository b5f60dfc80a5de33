// SPDX-License-Identifier: MIT
// The end of what a context's draws from arrays made: what is kept for a hidden part is sent before, and the nodes and
// the share group know it no more. No mutex is held. The context's thread.
#pragma once

#include <memory>
#include <vector>

#include "client_lib/context/context.h"
#include "client_lib/objects/vertex_input.h"

namespace wall::client {

/// What is known of an input's ranges.
void forget_ranges(Context& c, VertexInput& input);
void forget_inputs(Context& c, const std::vector<std::shared_ptr<VertexInput>>& inputs);

}  // namespace wall::client
