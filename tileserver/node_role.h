// SPDX-License-Identifier: MIT
// Which node of which wall a process is to be: by wall.toml on walld's machine, by what was kept when this machine
// joined on another one. Reads and writes files. One thread.
#pragma once

#include <string>
#include <vector>

#include "common/config/wall_config.h"
#include "tileserver/io/node_server.h"

namespace wall::tileserver {

/// Where it stands; `config` and `node`, or `state`, or all three on walld's machine with keys.
struct RoleSource {
    std::string config;  ///< wall.toml
    std::string node;    ///< [[node]] name
    std::string state;   ///< folder of a machine that has joined, or of this node's key
    std::string gpu{};   ///< the one node of those of its GPUs that the process is to be; empty: all that there are
};

class NodeRole {
public:
    /// Joins a wall of another machine with `line`, and keeps that in `state`.
    static Result<void> join(const std::string& line, const std::string& state);
    static Result<NodeRole> find(RoleSource source);

    const config::WallConfig& wall() const { return wall_; }
    /// The nodes of the wall that its tileserver is, one for each GPU; at least one.
    std::vector<config::NodeConfig> nodes() const { return wall_.nodes_of(name_); }
    /// The one that this process draws. Null: that is for its children, since there are several.
    const config::NodeConfig* node() const { return wall_.find_node(source_.gpu.empty() ? name_ : source_.gpu); }
    const NodeKeys& keys() const { return keys_; }

    /// walld goes by this wall.toml now, which a machine that has joined keeps. True: by it the node is one that this
    /// process cannot go on as, and find() would say so. Other headless tiles walld tells with its welcome. Where
    /// walld's machine has a file that says something else, walld has not read it yet, or reads another one: then this
    /// node stays what it is.
    bool described(const std::string& wall_toml) const;

private:
    NodeRole() = default;
    static Result<NodeRole> of_joined(RoleSource source);

    RoleSource source_;
    config::WallConfig wall_;
    std::string name_;
    NodeKeys keys_;
};

}  // namespace wall::tileserver
