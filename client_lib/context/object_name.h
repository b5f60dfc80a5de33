// SPDX-License-Identifier: MIT
// The application's names of what state elements name by id. The application's thread.
#pragma once

#include "client_lib/context/context.h"
#include "common/glstate/queries.h"

namespace wall::client {

/// The application's name of the object that a state element names by its id (glGet of a binding); 0: none.
GLuint object_name(Context& c, glstate::ValueKind kind, ClientName id);

}  // namespace wall::client
