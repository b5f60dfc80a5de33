// SPDX-License-Identifier: MIT
#include "walld/control/tokens.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/unique_fd.h"
#include "common/base/whole_file.h"
#include "common/json/parse_json.h"

namespace wall::walld {
namespace {

using nlohmann::json;
constexpr const char* kFile = "revoked_tokens.json";
constexpr std::size_t kMinSecret = 16, kMaxSecret = 1024;  // bytes

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

/// None if there is no such file.
Result<std::set<SecretDigest>> read_revoked(const std::filesystem::path& path) {
    std::set<SecretDigest> out;
    std::ifstream file(path, std::ios::binary);
    if (!file) return out;
    std::ostringstream text;
    text << file.rdbuf();
    const auto wrong = [&](const std::string& what) { return fail(path.string() + ": " + what); };
    const auto parsed = parse_json(text.str(), kFileJson);
    if (!parsed) return wrong(parsed.error().message);
    if (!parsed->is_array()) return wrong("expected a list of digests");
    for (const auto& entry : *parsed) {
        const auto digest = SecretDigest::parse(entry.is_string() ? entry.get<std::string>() : "");
        if (!digest) return wrong(digest.error().message);
        out.insert(*digest);
    }
    return out;
}

}  // namespace

Result<Tokens> Tokens::open(const std::vector<config::TokenConfig>& tokens, const std::filesystem::path& folder) {
    Tokens out(folder.empty() ? folder : folder / kFile);
    auto revoked = out.file_.empty() ? Result<std::set<SecretDigest>>() : read_revoked(out.file_);
    if (!revoked) return tl::unexpected(revoked.error());
    for (const auto& token : tokens) {
        const auto secret = read_secret(token);
        if (!secret) return tl::unexpected(secret.error());
        out.tokens_.push_back({{Person::Kind::token, token.name, 0, token.role}, SecretDigest::of(*secret)});
    }
    out.revoked_ = std::move(*revoked);
    return out;
}

Outcome<Person> Tokens::find(const SecretDigest& secret) const {
    const auto found = std::ranges::find(tokens_, secret, &Token::secret);
    if (found == tokens_.end()) return refuse(RefusalKind::forbidden, "this wall does not know that token");
    if (is_revoked(*found))
        return refuse(RefusalKind::forbidden,
                      found->person.text() + " was revoked: an operator may give it another secret");
    return found->person;
}

Outcome<Person> Tokens::revoke(std::string_view name) {
    const auto found = std::ranges::find_if(tokens_, [&](const Token& token) { return token.person.name == name; });
    if (found == tokens_.end())
        return refuse(RefusalKind::not_found,
                      "wall.toml has no [[people.token]] with the name '" + std::string(name) + "'");
    if (file_.empty())
        return refuse(RefusalKind::unavailable,
                      "walld has no state directory to write it down ('state_directory' in [wall] of wall.toml): take "
                      "the [[people.token]] out of wall.toml instead, and `wallctl reload`");
    auto revoked = revoked_;
    revoked.insert(found->secret);
    json list = json::array();
    for (const SecretDigest& secret : revoked) list.push_back(secret.text());
    if (auto written = write_whole(file_, list.dump(2) + "\n", 0640); !written)
        return refuse(RefusalKind::failed, written.error().message);
    revoked_ = std::move(revoked);
    return found->person;
}

}  // namespace wall::walld
