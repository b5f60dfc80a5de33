// SPDX-License-Identifier: MIT
#include "walld/control/machines.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/whole_file.h"
#include "common/json/parse_json.h"
#include "common/tls/secret.h"
#include "walld/control/names.h"

namespace wall::walld {
namespace {

using nlohmann::json;
constexpr const char* kFile = "machines.json";
constexpr std::array kMachineKinds{Machine::Kind::node, Machine::Kind::client};
constexpr std::array kRoles{Role::none, Role::viewer, Role::user, Role::operator_};

/// What `choices` calls `name`; an error names the member.
template <class T, std::size_t n>
Result<T> choice(const json& entry, const char* key, const std::array<T, n>& choices) {
    const auto found = entry.find(key);
    if (found != entry.end() && found->is_string()) {
        using config::name_of;  // of roles; of kinds it is ours
        for (const T value : choices)
            if (*found == name_of(value)) return value;
    }
    return fail(std::string("'") + key + "' is not known");
}

Result<Machine> read_machine(const json& entry) {
    if (!entry.is_object() || !entry.contains("name") || !entry["name"].is_string() || !entry.contains("key") ||
        !entry["key"].is_string())
        return fail("expected 'kind', 'name', 'role' and 'key' of each machine");
    const auto kind = choice(entry, "kind", kMachineKinds);
    const auto role = choice(entry, "role", kRoles);
    const auto key = tls::Fingerprint::parse(entry["key"].get<std::string>());
    if (!kind) return tl::unexpected(kind.error());
    if (!role) return tl::unexpected(role.error());
    if (!key) return tl::unexpected(key.error());
    return Machine{*kind, entry["name"], *role, *key};
}

Result<std::vector<Machine>> read_machines(const std::string& text) {
    const auto parsed = parse_json(text, kFileJson);
    if (!parsed) return tl::unexpected(parsed.error());
    if (!parsed->is_array()) return fail("expected a list of machines");
    std::vector<Machine> out;
    for (const auto& entry : *parsed) {
        auto machine = read_machine(entry);
        if (!machine) return tl::unexpected(machine.error());
        out.push_back(std::move(*machine));
    }
    return out;
}

auto called(Machine::Kind kind, const std::string& name) {
    return [kind, name](const Machine& machine) { return machine.kind == kind && machine.name == name; };
}

bool may_name_machine(const std::string& name) {
    const auto plain = [](unsigned char c) { return c > ' ' && c < 0x7f && c != '@' && c != '"' && c != '\\'; };
    return !name.empty() && name.size() <= kMaxName && std::ranges::all_of(name, plain);
}

tl::unexpected<Refusal> wrong_name() {
    return refuse(RefusalKind::invalid, "a machine's name has 1 to " + std::to_string(kMaxName) +
                                            " printable characters without blanks, quotes and '@'");
}

}  // namespace

const char* name_of(Machine::Kind kind) { return kind == Machine::Kind::node ? "node" : "client"; }

std::string Machine::text() const { return (kind == Kind::node ? "node " : "client host ") + name; }

Result<Machines> Machines::open(const std::filesystem::path& folder) {
    if (folder.empty()) return Machines({});
    Machines out(folder / kFile);
    std::ifstream file(out.file_, std::ios::binary);
    if (!file) return out;
    std::ostringstream text;
    text << file.rdbuf();
    auto machines = read_machines(text.str());
    if (!machines) return fail(out.file_.string() + ": " + machines.error().message);
    out.machines_ = std::move(*machines);
    return out;
}

Outcome<void> Machines::keep(std::vector<Machine> machines) {
    json list = json::array();
    for (const Machine& machine : machines)
        list.push_back({{"kind", name_of(machine.kind)},
                        {"name", machine.name},
                        {"role", config::name_of(machine.role)},
                        {"key", machine.key.text()}});
    const auto text = list.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
    if (auto written = write_whole(file_, text, 0640); !written)
        return refuse(RefusalKind::failed, written.error().message);
    machines_ = std::move(machines);
    return {};
}

Outcome<std::string> Machines::invite(const Machine& machine, const std::string& secret, Clock::time_point now) {
    if (file_.empty())
        return refuse(RefusalKind::unavailable,
                      "machines cannot join: walld has no state directory ('state_directory' in [wall] of wall.toml)");
    const bool names_itself = machine.kind == Machine::Kind::client && machine.name.empty();
    if (!names_itself && !may_name_machine(machine.name)) return wrong_name();
    std::erase_if(invitations_, [now](const Invitation& i) { return i.until <= now; });
    if (invitations_.size() >= kMaxInvitations)
        return refuse(RefusalKind::busy, std::to_string(kMaxInvitations) + " machines are awaited already");
    invitations_.push_back({secret, machine, now + kJoinTime});
    return secret;
}

Outcome<Machine> Machines::join(Machine::Kind kind, const std::string& secret, const std::string& host,
                                const tls::Fingerprint& key, Clock::time_point now) {
    const auto found =
        std::ranges::find_if(invitations_, [&](const Invitation& i) { return tls::same_secret(i.secret, secret); });
    if (found == invitations_.end() || found->until <= now)
        return refuse(RefusalKind::forbidden, "the join line is used up, or older than " +
                                                  std::to_string(kJoinTime.count()) +
                                                  " minutes: ask `wallctl join-token` for another one");
    if (found->machine.kind != kind)
        return refuse(RefusalKind::invalid, "the join line is for " + found->machine.text() + ", not for a " +
                                                (kind == Machine::Kind::node ? "node" : "client host"));
    Machine machine = found->machine;
    machine.key = key;
    if (machine.name.empty()) {
        if (!may_name_machine(host)) return wrong_name();
        const auto namesake = std::ranges::find_if(machines_, called(kind, host));
        if (namesake != machines_.end() && namesake->key != key)
            return refuse(RefusalKind::conflict, "another client host has joined as '" + host +
                                                     "': ask for a line with a name (wallctl join-token client NAME)");
        machine.name = host;
    }
    auto machines = machines_;
    // A key is one machine's, and a machine has one key.
    std::erase_if(machines, [&](const Machine& m) { return m.key == key || called(kind, machine.name)(m); });
    if (machines.size() >= kMaxMachines)
        return refuse(RefusalKind::busy, "the wall has " + std::to_string(kMaxMachines) + " machines: revoke some");
    machines.push_back(machine);
    if (auto kept = keep(std::move(machines)); !kept) return tl::unexpected(kept.error());
    invitations_.erase(found);
    return machine;
}

Outcome<Machine> Machines::revoke(Machine::Kind kind, const std::string& name) {
    auto machines = machines_;
    const auto found = std::ranges::find_if(machines, called(kind, name));
    if (found == machines.end())
        return refuse(RefusalKind::not_found, std::string("no ") + name_of(kind) + " has joined as '" + name + "'");
    const Machine gone = *found;
    machines.erase(found);
    if (auto kept = keep(std::move(machines)); !kept) return tl::unexpected(kept.error());
    return gone;
}

const Machine* Machines::find(const tls::Fingerprint& key) const {
    const auto found = std::ranges::find(machines_, key, &Machine::key);
    return found == machines_.end() ? nullptr : &*found;
}

}  // namespace wall::walld
