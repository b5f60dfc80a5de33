// SPDX-License-Identifier: MIT
// What this machine calls a user. May ask the name service, and wait for it. Any thread.
#pragma once

#include <sys/types.h>

#include <string>

namespace wall::wallagent {

/// The number as text for a user who has no name.
std::string name_of_user(uid_t user);

}  // namespace wall::wallagent
