// SPDX-License-Identifier: MIT
#include "tools/wallagent/user_name.h"

#include <pwd.h>

#include <vector>

namespace wall::wallagent {
namespace {

constexpr std::size_t kMaxEntry = 64 << 10;  // bytes of one user's entry

}  // namespace

std::string name_of_user(uid_t user) {
    passwd entry{};
    passwd* found = nullptr;
    std::vector<char> texts(kMaxEntry);
    if (::getpwuid_r(user, &entry, texts.data(), texts.size(), &found) != 0 || !found) return std::to_string(user);
    return found->pw_name;
}

}  // namespace wall::wallagent
