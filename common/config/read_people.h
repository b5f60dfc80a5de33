// SPDX-License-Identifier: MIT
// Reads the keys of wall.toml that name people. Asks the machine for users and groups. Any thread.
#pragma once

#include "common/config/people.h"
#include "common/config/tree_reader.h"

namespace wall::config {

/// `key` of `table`, if it is there: an array of user names, user numbers and "@group"; appended to `out`.
void read_members(TreeReader& read, const toml::table& table, std::string_view key, Members& out);
/// [people] of the file's `root`.
void read_people(TreeReader& read, const toml::table& root, PeopleConfig& out);

}  // namespace wall::config
