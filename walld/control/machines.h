// SPDX-License-Identifier: MIT
// Which other machines belong to the wall: their keys, and what they are. The one thing that walld writes down by
// itself, since nobody else could tell it (FOLDER/machines.json). A machine joins with the secret of a line that an
// operator has asked for: good once, and for kJoinTime. One thread.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/tls/fingerprint.h"
#include "walld/wall/person.h"

namespace wall::walld {

/// What a machine is to the wall.
struct Machine {
    enum class Kind { node, client };

    Kind kind = Kind::client;
    std::string name;        ///< of a node: [[node]] name
    Role role = Role::user;  ///< of the people on a client host
    tls::Fingerprint key{};

    /// "node left", "client host desk": for people and the log.
    std::string text() const;
};
const char* name_of(Machine::Kind kind);

class Machines {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::minutes kJoinTime{15};
    static constexpr std::size_t kMaxInvitations = 256, kMaxMachines = 4096;

    /// `folder`: walld's state; empty: no machine can join.
    static Result<Machines> open(const std::filesystem::path& folder);

    /// A secret for one machine, which takes the place of one that has this kind and name. A client host may come
    /// without a name.
    Outcome<std::string> invite(const Machine& machine, const std::string& secret, Clock::time_point now);
    /// The machine that has `key` from now on. The secret is used up. `host`: its own name, for a client host that was
    /// invited without one; such a name takes nobody's place.
    Outcome<Machine> join(Machine::Kind kind, const std::string& secret, const std::string& host,
                          const tls::Fingerprint& key, Clock::time_point now);
    /// The machine's key is nobody's any more.
    Outcome<Machine> revoke(Machine::Kind kind, const std::string& name);

    /// Null: no machine of the wall has that key.
    const Machine* find(const tls::Fingerprint& key) const;
    const std::vector<Machine>& all() const { return machines_; }

private:
    struct Invitation {
        std::string secret;
        Machine machine;
        Clock::time_point until;
    };
    explicit Machines(std::filesystem::path file) : file_(std::move(file)) {}
    Outcome<void> keep(std::vector<Machine> machines);

    std::filesystem::path file_;  ///< empty: nothing can be kept
    std::vector<Machine> machines_;
    std::vector<Invitation> invitations_;
};

}  // namespace wall::walld
