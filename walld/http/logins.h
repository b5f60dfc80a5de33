// SPDX-License-Identifier: MIT
// Who has signed in with a token at the status page: a browser then sends a cookie instead, which scripts cannot read,
// and which says nothing once walld has ended. Pure; the time is a parameter, and so are random bytes.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "walld/wall/person.h"

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
    std::string open(Person person, Clock::time_point now);
    /// Nothing for one that is over, or never was.
    std::optional<Person> find(std::string_view secret, Clock::time_point now);
    void close(std::string_view secret);
    std::size_t size() const { return open_.size(); }

private:
    struct Login {
        Person person;
        Clock::time_point until;
    };
    RandomBytes random_;
    std::map<std::string, Login> open_;  ///< by the digest of the secret: how long a search takes tells nothing of it
};

/// The value of a cookie in a `Cookie` header; empty if it is not there.
std::string_view cookie_value(std::string_view header, std::string_view name);

}  // namespace wall::walld
