// SPDX-License-Identifier: MIT
// A machine joins a wall: it shows walld the secret of a line that a person has carried over, over a connection to
// walld's very key, and walld notes this machine's key. Blocks; any thread.
#pragma once

#include <filesystem>

#include "common/base/result.h"
#include "common/join/membership.h"
#include "common/tls/join_line.h"

namespace wall::join {

/// Joins as `kind`, which must be what the line was made for, and keeps key and membership in `folder`, which is made.
/// An earlier membership there is replaced, the key is kept. Made by root, all of it belongs to the user that the
/// services run as (kWallUser), if there is one.
Result<Membership> join(const tls::JoinLine& line, MachineKind kind, const std::filesystem::path& folder);

}  // namespace wall::join
