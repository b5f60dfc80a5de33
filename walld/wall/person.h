// SPDX-License-Identifier: MIT
// Somebody who asks for something, and whether they may. Pure.
#pragma once

#include <cstdint>
#include <string>

#include "common/config/people.h"
#include "walld/wall/refusal.h"

namespace wall::walld {

using config::Role;

struct Person {
    enum class Kind { unix_user, token, host_user, machine, unknown };

    Kind kind = Kind::unknown;
    std::string name;        ///< of the user or the token; of a client host's user with the host, "alice@desk"
    std::uint32_t user = 0;  ///< of a Unix user
    Role role = Role::none;
    std::string machine{};  ///< the key (fingerprint, bytes) of the machine that they are at; empty: walld's own

    /// "alice", "token kiosk", "alice@desk", "somebody unknown": for people and the log.
    std::string text() const;
    /// Nobody unknown is the same as anybody.
    bool same_as(const Person& other) const;
};

/// What a request needs.
enum class Need {
    look,     ///< a viewer may
    own,      ///< a user may with what is theirs, an operator with all
    operate,  ///< an operator may
};

/// `what`: "move session 3"; `owner`: of what is meant, where there is one.
Outcome<void> may(const Person& who, Need need, const std::string& what, const Person* owner);

}  // namespace wall::walld
