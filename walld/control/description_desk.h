// SPDX-License-Identifier: MIT
// Changes what the wall is while it runs (wallctl reload, node add|remove|drain|undrain): checks all of it first, then
// tells the wall, the nodes that are described otherwise, and who watches. One thread.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "walld/control/identity.h"
#include "walld/control/machine_desk.h"
#include "walld/control/wall_file.h"
#include "walld/control/who_is_there.h"
#include "walld/streams/stream_hub.h"
#include "walld/wall/wall.h"

namespace wall::walld {

/// The connections of nodes.
class NodeLinks {
public:
    virtual ~NodeLinks() = default;
    /// The node's link is closed when what was sent has gone; it may come again. Nothing if it is away.
    virtual void let_go(NodeIndex node, const std::string& reason) = 0;
};

class DescriptionDesk {
public:
    /// What a change is told to.
    struct Told {
        Wall& wall;
        Identities& identities;
        WhoIsThere& who;
        MachineDesk& machines;
        StreamHub& streams;
        Outbox& out;
        NodeLinks& links;
    };
    /// `toml`: what the wall was made from. `state`: walld's folder.
    DescriptionDesk(WallFile file, std::string toml, std::filesystem::path state, const Told& told);

    /// As the files are now → {"nodes": [those that start anew, come or go], "tiles": how many the wall has}. On an
    /// error everything is as it was.
    Outcome<nlohmann::json> reload();
    /// {"toml": a [[node]] table}
    Outcome<nlohmann::json> add(const nlohmann::json& arguments);
    /// {"name"}: of one that was added.
    Outcome<nlohmann::json> remove(const nlohmann::json& arguments);
    /// {"name"}: programs leave the node, until undrain().
    Outcome<nlohmann::json> drain(const nlohmann::json& arguments) { return set_drained(arguments, true); }
    Outcome<nlohmann::json> undrain(const nlohmann::json& arguments) { return set_drained(arguments, false); }

    /// What a node is told behind its welcome.
    void tell(NodeIndex node) const;

private:
    void drain() const;
    Outcome<nlohmann::json> take(Outcome<Description> next);
    Outcome<nlohmann::json> set_drained(const nlohmann::json& arguments, bool on);

    WallFile file_;
    std::string toml_;
    std::filesystem::path state_;
    Told told_;
};

}  // namespace wall::walld
