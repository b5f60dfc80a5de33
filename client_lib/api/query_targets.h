// SPDX-License-Identifier: MIT
// What queries may be about (queries.cpp).
#pragma once

#include <optional>

#include "client_lib/context/query_state.h"
#include "common/glapi/gl_types.h"

namespace wall::client::api {

/// Where a query of that target is current; nothing: no such target.
std::optional<QuerySlot> slot_of_query(GLenum target);

}  // namespace wall::client::api
