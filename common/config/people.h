// SPDX-License-Identifier: MIT
// Who may do what with a wall: the [people] part of wall.toml, and the decision for one peer. Pure. Any thread.
//
//   viewer    sees everything, changes nothing
//   user      puts programs on the wall; moves and closes the own ones
//   operator  moves and closes all of them, keeps layouts, runs nodes
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace wall::config {

enum class Role { none, viewer, user, operator_ };  ///< each may all that the ones before it may
const char* name_of(Role role);

/// Unix users, by themselves or by a group.
struct Members {
    std::vector<std::uint32_t> users, groups;
};

/// A secret that stands for a person, for peers that have no Unix user here.
struct TokenConfig {
    std::string name;  ///< unique; whom it stands for
    std::string file;  ///< holds the secret
    Role role = Role::user;
};

struct PeopleConfig {
    Members operators, users, viewers;
    Role default_role = Role::none;  ///< of a Unix user who is in none of them
    Role http_role = Role::viewer;   ///< of whoever asks over HTTP, at least
    std::vector<TokenConfig> tokens;
};

/// Root is an operator. walld's own user as well, for which the caller sees.
Role role_of(const PeopleConfig& people, std::uint32_t user, std::span<const std::uint32_t> groups);

}  // namespace wall::config
