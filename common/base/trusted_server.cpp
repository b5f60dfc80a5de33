// SPDX-License-Identifier: MIT
#include "common/base/trusted_server.h"

#include <pwd.h>
#include <unistd.h>

#include <charconv>
#include <cstdlib>
#include <optional>
#include <vector>

#include "common/base/socket_peer.h"

namespace wall {
namespace {

constexpr std::size_t kMaxEntry = 64 << 10;  // bytes of one user's entry

std::optional<uid_t> user_called(const std::string& name) {
    uid_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc{} && end == name.data() + name.size()) return number;
    passwd entry{};
    passwd* found = nullptr;
    std::vector<char> texts(kMaxEntry);
    if (::getpwnam_r(name.c_str(), &entry, texts.data(), texts.size(), &found) != 0 || !found) return std::nullopt;
    return found->pw_uid;
}

}  // namespace

Result<void> check_server(int fd, const std::string& wall_user) {
    if (wall_user == "*") return {};
    const auto server = server_of(fd);
    if (!server) return fail("nobody knows whose process it is");
    if (server->user == 0 || server->user == ::geteuid() || user_called(wall_user) == server->user) return {};
    return fail("it is a process of user " + std::to_string(server->user) + ", not of '" + wall_user +
                "', root or this program's user");
}

std::string wall_user_from_environment() {
    const char* given = ::secure_getenv("WALLGL_WALLD_USER");  // none in a process with more rights than its user
    return given && *given ? given : kWallUser;
}

}  // namespace wall
