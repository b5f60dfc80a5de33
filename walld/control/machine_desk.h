// SPDX-License-Identifier: MIT
// What operators ask about machines (wallctl join-token, machines, revoke), and who comes from one: machines that join,
// nodes, people on client hosts. One thread.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "common/config/wall_config.h"
#include "common/tls/tls_context.h"
#include "proto/control.pb.h"
#include "walld/control/machines.h"

namespace wall::walld {

/// The connections that other machines have, as of now.
class MachineLinks {
public:
    virtual ~MachineLinks() = default;
    virtual std::set<tls::Fingerprint> connected() const = 0;
    /// Ends all of the machine that has `key`.
    virtual void cut(const tls::Fingerprint& key, const std::string& reason) = 0;
};

/// What walld has for other machines.
struct WalldKeys {
    std::shared_ptr<const tls::TlsContext> tls;  ///< null: nobody beyond this machine is let in
    Machines machines;
};

class MachineDesk {
public:
    using Clock = Machines::Clock;
    using RandomBytes = std::function<std::string(std::size_t)>;

    MachineDesk(WalldKeys keys, const config::WallConfig& config, MachineLinks& links, RandomBytes random)
        : keys_(std::move(keys)), config_(config), links_(links), random_(std::move(random)) {}

    /// The wall's description, for nodes that join.
    void set_wall_toml(std::string toml) { wall_toml_ = std::move(toml); }
    /// Null: this wall is on one machine.
    const std::shared_ptr<const tls::TlsContext>& tls() const { return keys_.tls; }

    /// {"kind", "name", "role", "address"} → {"line", "command", "valid_s"}
    Outcome<nlohmann::json> invite(const nlohmann::json& arguments, Clock::time_point now);
    /// Those that have joined.
    nlohmann::json list() const;
    /// {"kind", "name"}: its key is nobody's any more, and its connections end.
    Outcome<void> revoke(const nlohmann::json& arguments);

    /// To a machine's first message.
    Outcome<proto::JoinAnswer> join(const proto::JoinRequest& request, const tls::Fingerprint& key,
                                    Clock::time_point now);
    /// The node that has this key, as somebody who may run it and nothing else.
    Outcome<Person> node(const proto::NodeHello& hello, const tls::Fingerprint& key) const;
    /// Whom a client host's agent stands for.
    Outcome<Person> user(const proto::HostHello& hello, const tls::Fingerprint& key) const;

private:
    Outcome<const Machine*> known(const tls::Fingerprint& key, Machine::Kind kind) const;
    Outcome<net::Address> reachable(const nlohmann::json& arguments) const;

    WalldKeys keys_;
    std::string wall_toml_;
    const config::WallConfig& config_;
    MachineLinks& links_;
    RandomBytes random_;
};

}  // namespace wall::walld
