// SPDX-License-Identifier: MIT
#include "walld/control/machine_desk.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/tls/join_line.h"
#include "common/wire/limits.h"
#include "walld/control/arguments.h"

namespace wall::walld {
namespace {

using nlohmann::json;
constexpr std::size_t kMaxUser = 64;  // bytes of a user's name

Outcome<Machine::Kind> kind_of(const json& arguments) {
    return text_of(arguments, "kind").and_then([](const std::string& text) -> Outcome<Machine::Kind> {
        for (const auto kind : {Machine::Kind::node, Machine::Kind::client})
            if (text == name_of(kind)) return kind;
        return refuse(RefusalKind::invalid, "'kind': expected \"node\" or \"client\"");
    });
}

Outcome<Role> role_of(const json& arguments) {
    return text_of(arguments, "role").and_then([](const std::string& text) -> Outcome<Role> {
        if (text.empty()) return Role::user;
        for (const auto role : {Role::viewer, Role::user, Role::operator_})
            if (text == config::name_of(role)) return role;
        return refuse(RefusalKind::invalid, "'role': expected \"viewer\", \"user\" or \"operator\"");
    });
}

Outcome<Machine> machine_of(const json& arguments) {
    const auto kind = kind_of(arguments);
    const auto name = text_of(arguments, "name");
    const auto role = role_of(arguments);
    if (!kind) return tl::unexpected(kind.error());
    if (!name) return tl::unexpected(name.error());
    if (!role) return tl::unexpected(role.error());
    return Machine{*kind, *name, *role};
}

/// Joins and starts the service, now and with the machine.
std::string command_for(const Machine& machine, const std::string& line) {
    constexpr std::string_view enable = " && systemctl enable --now ";
    if (machine.kind == Machine::Kind::client) return fmt::format("wallctl join {}{}wallagent", line, enable);
    return fmt::format("wallctl join {} --node {}{}tileserver-joined@{}", line, machine.name, enable, machine.name);
}

Outcome<void> check_version(std::uint32_t version) {
    if (version == wire::kProtocolVersion) return {};
    return refuse(RefusalKind::invalid, "walld speaks protocol version " + std::to_string(wire::kProtocolVersion) +
                                            ", this machine " + std::to_string(version));
}

}  // namespace

/// Where the machine that joins finds walld: what it listens on, or what was said because that is any of its addresses.
Outcome<net::Address> MachineDesk::reachable(const json& arguments) const {
    const auto given = text_of(arguments, "address");
    if (!given) return tl::unexpected(given.error());
    const auto listens = std::ranges::find_if(config_.control_listen, [](const auto& a) { return !a.local(); });
    if (listens == config_.control_listen.end() || !keys_.tls)
        return refuse(RefusalKind::unavailable,
                      "walld listens nowhere that other machines reach: add HOST:PORT to 'listen' in [control] of "
                      "wall.toml");
    if (given->empty() && !listens->any()) return *listens;
    if (given->empty())
        return refuse(RefusalKind::invalid,
                      "walld listens on all of its addresses: say which one the machine shall "
                      "use (--address HOST:PORT)");
    auto address = net::Address::parse(*given);
    if (!address || address->is_unix()) return refuse(RefusalKind::invalid, "'address': expected HOST:PORT");
    return std::move(*address);
}

Outcome<json> MachineDesk::invite(const json& arguments, Clock::time_point now) {
    const auto machine = machine_of(arguments);
    if (!machine) return tl::unexpected(machine.error());
    auto walld = reachable(arguments);
    if (!walld) return tl::unexpected(walld.error());
    if (machine->kind == Machine::Kind::node && config_.nodes_of(machine->name).empty())
        return refuse(RefusalKind::not_found, "wall.toml has no [[node]] with the name '" + machine->name + "'");
    const auto secret = keys_.machines.invite(*machine, random_(tls::JoinLine::kSecretBytes), now);
    if (!secret) return tl::unexpected(secret.error());
    const auto line = tls::JoinLine{std::move(*walld), keys_.tls->fingerprint(), *secret}.text();
    return json{{"line", line},
                {"command", command_for(*machine, line)},
                {"valid_s", std::chrono::seconds(Machines::kJoinTime).count()}};
}

json MachineDesk::list() const {
    const auto connected = links_.connected();
    json out = json::array();
    for (const Machine& machine : keys_.machines.all())
        out.push_back({{"kind", name_of(machine.kind)},
                       {"name", machine.name},
                       {"role", machine.kind == Machine::Kind::node ? "node" : config::name_of(machine.role)},
                       {"key", machine.key.text()},
                       {"up", connected.contains(machine.key)}});
    return out;
}

Outcome<void> MachineDesk::revoke(const json& arguments) {
    const auto kind = kind_of(arguments);
    const auto name = text_of(arguments, "name");
    if (!kind) return tl::unexpected(kind.error());
    if (!name) return tl::unexpected(name.error());
    const auto gone = keys_.machines.revoke(*kind, *name);
    if (!gone) return tl::unexpected(gone.error());
    links_.cut(gone->key, gone->text() + " was revoked by an operator");
    return {};
}

Outcome<proto::JoinAnswer> MachineDesk::join(const proto::JoinRequest& request, const tls::Fingerprint& key,
                                             Clock::time_point now) {
    if (const auto good = check_version(request.version()); !good) return tl::unexpected(good.error());
    const auto kind = request.node() ? Machine::Kind::node : Machine::Kind::client;
    const auto machine = keys_.machines.join(kind, request.secret(), request.host(), key, now);
    if (!machine) return tl::unexpected(machine.error());
    proto::JoinAnswer answer;
    answer.set_name(machine->name);
    if (request.node()) answer.set_wall_toml(wall_toml_);
    return answer;
}

Outcome<const Machine*> MachineDesk::known(const tls::Fingerprint& key, Machine::Kind kind) const {
    const Machine* machine = keys_.machines.find(key);
    if (!machine)
        return refuse(RefusalKind::forbidden, "the wall does not know this machine's key " + key.text() +
                                                  " (any more): `wallctl join-token` lets it join");
    if (machine->kind != kind) return refuse(RefusalKind::forbidden, "this machine has joined as " + machine->text());
    return machine;
}

Outcome<Person> MachineDesk::node(const proto::NodeHello& hello, const tls::Fingerprint& key) const {
    const auto machine = known(key, Machine::Kind::node);
    if (!machine) return tl::unexpected(machine.error());
    const auto* node = config_.find_node(hello.name());
    if ((*machine)->name != (node ? node->process : hello.name()))
        return refuse(RefusalKind::forbidden, "this machine has joined as " + (*machine)->text());
    if (hello.key() != key.bytes())
        return refuse(RefusalKind::invalid, "a node's data port needs the key that it has joined with");
    return Person{Person::Kind::machine, (*machine)->text(), 0, Role::operator_, key.bytes()};
}

Outcome<Person> MachineDesk::user(const proto::HostHello& hello, const tls::Fingerprint& key) const {
    if (const auto good = check_version(hello.version()); !good) return tl::unexpected(good.error());
    const auto machine = known(key, Machine::Kind::client);
    if (!machine) return tl::unexpected(machine.error());
    const auto name = hello.user().substr(0, kMaxUser) + "@" + (*machine)->name;
    return Person{Person::Kind::host_user, name, hello.uid(), (*machine)->role, key.bytes()};
}

}  // namespace wall::walld
