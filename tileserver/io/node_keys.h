// SPDX-License-Identifier: MIT
// What a node's process has from whoever starts it. Any thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/net/address.h"
#include "common/net/control_connection.h"

namespace wall::tileserver {

/// A walld of another machine.
struct JoinedWall {
    net::Address walld;
    tls::Fingerprint walld_key;
};

/// What a node has for links between machines; nothing: it lives on walld's.
struct NodeKeys {
    std::shared_ptr<const tls::TlsContext> tls;  ///< null: nobody beyond this machine is let in
    std::optional<JoinedWall> joined;            ///< none: the first address of [control]; needs `tls`
};

/// Told what walld goes by, a wall.toml. True: this node is described otherwise now, and is to start anew.
using Described = std::function<bool(const std::string& wall_toml)>;

}  // namespace wall::tileserver
