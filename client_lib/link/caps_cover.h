// SPDX-License-Identifier: MIT
// Whether another wall can do what a program was promised by the one that it is on. Pure; any thread.
#pragma once

#include <string>

#include "client_lib/link/control_messages.h"

namespace wall::client {

/// What `wall` lacks of what was promised, for people, such as "OpenGL 4.5 (it has 3.3)"; empty: nothing.
std::string lacking(const Caps& wall, const Caps& promised);

}  // namespace wall::client
