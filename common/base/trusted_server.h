// SPDX-License-Identifier: MIT
// Whom a program or a node takes for walld, before it says anything secret to it: root, its own user, and the user that
// walls run as. Whoever else takes walld's address while that is away is told nothing (docs/security.md). Any thread.
#pragma once

#include <string>

#include "common/base/result.h"

namespace wall {

/// The user that the package's services run as.
inline constexpr const char* kWallUser = "wallgl";

/// `fd`: a connection that we have made; `wall_user`: walld's user, a name or a number, "*" for anybody. May ask the
/// name service.
Result<void> check_server(int fd, const std::string& wall_user);
/// WALLGL_WALLD_USER, or the default.
std::string wall_user_from_environment();

}  // namespace wall
