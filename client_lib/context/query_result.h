// SPDX-License-Identifier: MIT
// The answers to queries. What nodes count they are asked for when somebody wants to know, all at once; times come from
// this machine's clock, so that the wall's nodes need none in common. Application's thread.
#pragma once

#include <cstdint>

#include "client_lib/context/context.h"
#include "client_lib/context/query_state.h"

namespace wall::client {

/// Whether the result is there. The first time it asks for it, without waiting.
bool is_available(Context& c, QueryObject& query);
/// Waits for it.
std::uint64_t result_of(Context& c, QueryObject& query);

/// Nanoseconds of the clock that GL_TIMESTAMP is of.
std::uint64_t timestamp(Fence::Clock::time_point at);

}  // namespace wall::client
