// SPDX-License-Identifier: MIT
#include "walld/http/logins.h"

#include <algorithm>
#include <utility>

#include "common/tls/fingerprint.h"

namespace wall::walld {

std::string Logins::open(const SecretDigest& token, Clock::time_point now) {
    std::erase_if(open_, [&](const auto& entry) { return entry.second.until <= now; });
    if (open_.size() >= kMost)
        open_.erase(std::ranges::min_element(open_, {}, [](const auto& entry) { return entry.second.until; }));
    auto secret = tls::to_base64url(random_(kSecretBytes));
    open_[SecretDigest::of(secret)] = {token, now + kLifetime};
    return secret;
}

std::optional<SecretDigest> Logins::find(std::string_view secret, Clock::time_point now) {
    const auto found = open_.find(SecretDigest::of(secret));
    if (found == open_.end()) return std::nullopt;
    if (found->second.until > now) return found->second.token;
    open_.erase(found);
    return std::nullopt;
}

void Logins::close(std::string_view secret) { open_.erase(SecretDigest::of(secret)); }

std::string_view cookie_value(std::string_view header, std::string_view name) {
    while (!header.empty()) {
        auto part = header.substr(0, header.find(';'));
        header.remove_prefix(std::min(header.size(), part.size() + 1));
        while (part.starts_with(' ')) part.remove_prefix(1);
        if (part.starts_with(name) && part.substr(name.size()).starts_with('=')) return part.substr(name.size() + 1);
    }
    return {};
}

}  // namespace wall::walld
