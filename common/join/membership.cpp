// SPDX-License-Identifier: MIT
#include "common/join/membership.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include "common/base/whole_file.h"
#include "common/json/parse_json.h"

namespace wall::join {
namespace {

constexpr std::array kKinds{MachineKind::node, MachineKind::client};

/// A member that is a text; empty for anything else, which no check takes.
std::string text_of(const nlohmann::json& json, const char* key) {
    const auto found = json.is_object() ? json.find(key) : json.end();
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Result<Membership> read(const nlohmann::json& json) {
    Membership out;
    const auto kind =
        std::ranges::find(kKinds, text_of(json, "kind"), [](MachineKind k) { return std::string(name_of(k)); });
    if (kind == kKinds.end()) return fail("'kind': expected \"node\" or \"client\"");
    out.kind = *kind;
    out.name = text_of(json, "name");
    if (out.name.empty()) return fail("'name': expected what the wall calls this machine");
    auto walld = Address::parse(text_of(json, "walld"));
    if (!walld || walld->is_unix()) return fail("'walld': expected HOST:PORT");
    out.walld = std::move(*walld);
    const auto key = tls::Fingerprint::parse(text_of(json, "walld_key"));
    if (!key) return fail("'walld_key': " + key.error().message);
    out.walld_key = *key;
    return out;
}

}  // namespace

const char* name_of(MachineKind kind) { return kind == MachineKind::node ? "node" : "client"; }

std::filesystem::path membership_file(const std::filesystem::path& folder) { return folder / "joined.json"; }
std::filesystem::path key_file(const std::filesystem::path& folder) { return folder / "key.pem"; }
std::filesystem::path wall_file(const std::filesystem::path& folder) { return folder / "wall.toml"; }

Result<Membership> Membership::load(const std::filesystem::path& folder) {
    const auto path = membership_file(folder);
    std::ifstream file(path, std::ios::binary);
    if (!file)
        return fail(path.string() +
                    ": cannot be read: this machine has not joined a wall (`wallctl join-token` on "
                    "walld's machine prints the command that does it)");
    std::ostringstream text;
    text << file.rdbuf();
    const auto json = parse_json(text.str(), kFileJson);
    auto out = json ? read(*json) : Result<Membership>(tl::unexpected(json.error()));
    return out ? out : fail(path.string() + ": " + out.error().message);
}

Result<void> Membership::save(const std::filesystem::path& folder) const {
    const nlohmann::json json{
        {"kind", name_of(kind)}, {"name", name}, {"walld", walld.text()}, {"walld_key", walld_key.text()}};
    return write_whole(membership_file(folder), json.dump(2) + "\n", 0644);
}

}  // namespace wall::join
