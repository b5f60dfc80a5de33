// SPDX-License-Identifier: MIT
#include "walld/control/identity.h"

#include <grp.h>
#include <pwd.h>
#include <unistd.h>

#include <array>
#include <vector>

namespace wall::walld {
namespace {

constexpr std::size_t kMaxEntry = 64 << 10;  // bytes of one user's entry
constexpr std::string_view kBearer = "Bearer ";

std::vector<std::uint32_t> groups_of(const passwd& user) {
    std::array<gid_t, 256> groups;
    int count = groups.size();
    if (::getgrouplist(user.pw_name, user.pw_gid, groups.data(), &count) < 0) count = groups.size();
    return {groups.begin(), groups.begin() + count};
}

}  // namespace

Result<Identities> Identities::open(const config::PeopleConfig& people, const std::filesystem::path& state) {
    auto tokens = Tokens::open(people.tokens, state);
    if (!tokens) return tl::unexpected(tokens.error());
    return Identities(people, std::move(*tokens));
}

Person Identities::of(std::uint32_t user) const {
    Person out{Person::Kind::unix_user, "uid " + std::to_string(user), user, Role::none};
    std::vector<std::uint32_t> groups;
    passwd entry{};
    passwd* found = nullptr;
    std::vector<char> texts(kMaxEntry);
    if (::getpwuid_r(user, &entry, texts.data(), texts.size(), &found) == 0 && found) {
        out.name = found->pw_name;
        groups = groups_of(*found);
    }
    out.role = user == ::geteuid() ? Role::operator_ : config::role_of(people_, user, groups);
    return out;
}

Outcome<Person> Identities::with_token(Person base, std::string_view token) const {
    if (token.empty()) return base;
    return tokens_.find(SecretDigest::of(token)).map([&](Person person) {
        person.machine = std::move(base.machine);
        return person;
    });
}

Outcome<Person> Identities::over_http(const Person& base, std::string_view authorization, bool local) const {
    if (!authorization.empty() && (!authorization.starts_with(kBearer) || authorization.size() == kBearer.size()))
        return refuse(RefusalKind::forbidden, "expected 'Authorization: Bearer TOKEN'");
    const auto token = authorization.empty() ? authorization : authorization.substr(kBearer.size());
    return with_token(base, token).map([&](Person person) {
        if (local) person.role = std::max(person.role, people_.http_role);
        return person;
    });
}

}  // namespace wall::walld
