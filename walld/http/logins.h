// SPDX-License-Identifier: MIT
// Who has signed in with a token at the status page: a browser then sends a cookie instead, which scripts cannot read,
// and which says nothing once walld has ended. It stands for the token's secret, whatever that may mean meanwhile.
// Pure; the time is a parameter, and so are random bytes.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "walld/control/secret_digest.h"

namespace wall::walld {

class Logins {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::hours kLifetime{12};
    static constexpr std::size_t kMost = 1024;  ///< of all people; then the oldest one is over
    static constexpr std::size_t kSecretBytes = 32;
    using RandomBytes = std::function<std::string(std::size_t)>;

    explicit Logins(RandomBytes random) : random_(std::move(random)) {}

    /// The cookie's value: letters, digits, - and _.
    std::string open(const SecretDigest& token, Clock::time_point now);
    /// The token that it stands for; nothing for one that is over, or never was.
    std::optional<SecretDigest> find(std::string_view secret, Clock::time_point now);
    void close(std::string_view secret);
    std::size_t size() const { return open_.size(); }

private:
    struct Login {
        SecretDigest token;
        Clock::time_point until;
    };
    RandomBytes random_;
    std::map<SecretDigest, Login> open_;  ///< by the cookie
};

/// The value of a cookie in a `Cookie` header; empty if it is not there.
std::string_view cookie_value(std::string_view header, std::string_view name);

}  // namespace wall::walld
