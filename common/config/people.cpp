// SPDX-License-Identifier: MIT
#include "common/config/people.h"

#include <algorithm>

namespace wall::config {

const char* name_of(Role role) {
    switch (role) {
        case Role::none: return "none";
        case Role::viewer: return "viewer";
        case Role::user: return "user";
        case Role::operator_: return "operator";
    }
    return "";
}

Role role_of(const PeopleConfig& people, std::uint32_t user, std::span<const std::uint32_t> groups) {
    const auto in = [&](const Members& members) {
        const auto member = [&](std::uint32_t group) { return std::ranges::count(members.groups, group) > 0; };
        return std::ranges::count(members.users, user) > 0 || std::ranges::any_of(groups, member);
    };
    if (user == 0 || in(people.operators)) return Role::operator_;
    if (in(people.users)) return std::max(Role::user, people.default_role);
    if (in(people.viewers)) return std::max(Role::viewer, people.default_role);
    return people.default_role;
}

}  // namespace wall::config
