// SPDX-License-Identifier: MIT
#include "common/config/read_people.h"

#include <grp.h>
#include <pwd.h>

#include <set>

namespace wall::config {
namespace {

constexpr std::array kRoles{Role::none, Role::viewer, Role::user, Role::operator_};

/// "@wheel" or "alice".
void read_name(TreeReader& read, const toml::node& node, const std::string& name, std::string_view key, Members& out) {
    if (name.starts_with('@')) {
        if (const group* entry = ::getgrnam(name.c_str() + 1)) out.groups.push_back(entry->gr_gid);
        else
            read.refuse(node.source(),
                        TreeReader::quoted(key) + ": this machine has no group '" + name.substr(1) + "'");
        return;
    }
    if (const passwd* entry = ::getpwnam(name.c_str())) out.users.push_back(entry->pw_uid);
    else read.refuse(node.source(), TreeReader::quoted(key) + ": this machine has no user '" + name + "'");
}

void read_member(TreeReader& read, const toml::node& node, std::string_view key, Members& out) {
    if (const auto* name = node.as_string()) return read_name(read, node, from_private_use(name->get()), key, out);
    const auto* uid = node.as_integer();
    if (uid && uid->get() >= 0 && uid->get() < UINT32_MAX) out.users.push_back(static_cast<std::uint32_t>(uid->get()));
    else read.refuse(node.source(), TreeReader::quoted(key) + ": expected user names, user numbers or \"@group\"");
}

Role read_role(TreeReader& read, const toml::table& table, std::string_view key, Role otherwise) {
    if (!table.get(key)) return otherwise;
    const auto text = read.text(table, key);
    const auto found = std::ranges::find(kRoles, text, [](Role role) { return std::string(name_of(role)); });
    if (found != kRoles.end()) return *found;
    read.refuse(table.get(key)->source(),
                TreeReader::quoted(key) + ": expected \"none\", \"viewer\", \"user\" or \"operator\"");
    return otherwise;
}

void read_tokens(TreeReader& read, const toml::table& people, std::vector<TokenConfig>& out) {
    if (!people.get("token")) return;
    std::set<std::string> names;
    for (const auto* table : read.tables(people, "token", "[[people.token]]")) {
        read.only(*table, "[[people.token]]", {"name", "file", "role"});
        out.push_back(
            {read.text(*table, "name"), read.text(*table, "file"), read_role(read, *table, "role", Role::user)});
        if (!names.insert(out.back().name).second)
            read.refuse(table->source(), "token '" + out.back().name + "' appears twice: expected unique names");
    }
}

}  // namespace

void read_members(TreeReader& read, const toml::table& table, std::string_view key, Members& out) {
    const auto* node = table.get(key);
    if (!node) return;
    const auto* array = node->as_array();
    if (!array)
        read.refuse(node->source(),
                    TreeReader::quoted(key) + ": expected an array of user names, user numbers or \"@group\"");
    for (std::size_t i = 0; array && i < array->size(); ++i) read_member(read, *array->get(i), key, out);
}

void read_people(TreeReader& read, const toml::table& root, PeopleConfig& out) {
    const auto& people = read.section(root, "people");
    read.only(people, "[people]", {"operators", "users", "viewers", "default_role", "http_role", "token"});
    read_members(read, people, "operators", out.operators);
    read_members(read, people, "users", out.users);
    read_members(read, people, "viewers", out.viewers);
    out.default_role = read_role(read, people, "default_role", out.default_role);
    out.http_role = read_role(read, people, "http_role", out.http_role);
    read_tokens(read, people, out.tokens);
}

}  // namespace wall::config
