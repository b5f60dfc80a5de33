// SPDX-License-Identifier: MIT
#include "walld/control/identity.h"

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>

#include "common/base/unique_fd.h"

namespace wall::walld {
namespace {

constexpr std::size_t kMinSecret = 16, kMaxSecret = 1024;  // bytes
constexpr std::size_t kMaxEntry = 64 << 10;                // bytes of one user's entry
constexpr std::string_view kBearer = "Bearer ";

Result<std::string> read_secret(const config::TokenConfig& token) {
    const auto wrong = [&](const std::string& what) {
        return fail("token '" + token.name + "': " + token.file + ": " + what);
    };
    const UniqueFd fd(::open(token.file.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat info {};
    if (!fd || ::fstat(fd.get(), &info) != 0) return wrong("cannot be read");
    if (!S_ISREG(info.st_mode) || (info.st_mode & 077) != 0)
        return wrong("expected a file that only its owner can read (chmod 600)");
    std::array<char, kMaxSecret + 1> bytes;
    const auto n = ::read(fd.get(), bytes.data(), bytes.size());
    std::string secret(bytes.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
    while (!secret.empty() && (secret.back() == '\n' || secret.back() == '\r')) secret.pop_back();
    if (secret.size() < kMinSecret || secret.size() > kMaxSecret)
        return wrong("expected a secret of " + std::to_string(kMinSecret) + " to " + std::to_string(kMaxSecret) +
                     " bytes");
    return secret;
}

/// Takes as long for a wrong one that begins right as for any other.
bool same(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
    return difference == 0;
}

std::vector<std::uint32_t> groups_of(const passwd& user) {
    std::array<gid_t, 256> groups;
    int count = groups.size();
    if (::getgrouplist(user.pw_name, user.pw_gid, groups.data(), &count) < 0) count = groups.size();
    return {groups.begin(), groups.begin() + count};
}

}  // namespace

Result<Identities> Identities::open(const config::PeopleConfig& people) {
    Identities out(people);
    for (const auto& token : people.tokens) {
        auto secret = read_secret(token);
        if (!secret) return tl::unexpected(secret.error());
        out.tokens_.push_back({std::move(*secret), {Person::Kind::token, token.name, 0, token.role}});
    }
    return out;
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
    for (const auto& known : tokens_) {
        if (!same(known.secret, token)) continue;
        Person person = known.person;
        person.machine = std::move(base.machine);
        return person;
    }
    return refuse(RefusalKind::forbidden, "this wall does not know that token");
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
