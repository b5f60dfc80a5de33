// SPDX-License-Identifier: MIT
// What a machine keeps of the wall that it has joined, in a folder of its own (docs/operation.md, "Walls of several
// machines"). Any thread.
//
//     key.pem       its key, readable by its owner alone
//     joined.json   where walld is, walld's fingerprint, and what the wall calls this machine
//     wall.toml     of a node: the wall's description, as walld had it when the node joined or came last
#pragma once

#include <filesystem>
#include <string>

#include "common/base/address.h"
#include "common/base/result.h"
#include "common/tls/fingerprint.h"

namespace wall::join {

enum class MachineKind { node, client };
const char* name_of(MachineKind kind);  ///< "node", "client"

struct Membership {
    MachineKind kind = MachineKind::client;
    std::string name;
    Address walld;
    tls::Fingerprint walld_key;

    /// An error for a machine that has not joined: it says how that is done.
    static Result<Membership> load(const std::filesystem::path& folder);
    Result<void> save(const std::filesystem::path& folder) const;
};

std::filesystem::path membership_file(const std::filesystem::path& folder);
std::filesystem::path key_file(const std::filesystem::path& folder);
std::filesystem::path wall_file(const std::filesystem::path& folder);

}  // namespace wall::join
