// SPDX-License-Identifier: MIT
// Who is at the other end: the kernel says which user a local socket belongs to, a token says it for everybody else.
// Asks the machine for names and groups. One thread, but for what says otherwise.
#pragma once

#include <filesystem>
#include <string_view>

#include "common/base/result.h"
#include "walld/control/tokens.h"

namespace wall::walld {

class Identities {
public:
    /// Reads the tokens' files. `state`: walld's folder, see Tokens.
    static Result<Identities> open(const config::PeopleConfig& people, const std::filesystem::path& state);

    /// Asks the name service, which may take its time. Any thread.
    Person of(std::uint32_t user) const;
    /// The person that `token` stands for; `base` if there is none (empty).
    Outcome<Person> with_token(Person base, std::string_view token) const;
    /// Over HTTP everybody of this machine has at least the role that the configuration gives (`local`).
    Outcome<Person> over_http(const Person& base, std::string_view authorization, bool local) const;

    Tokens& tokens() { return tokens_; }
    const Tokens& tokens() const { return tokens_; }

private:
    Identities(config::PeopleConfig people, Tokens tokens) : people_(std::move(people)), tokens_(std::move(tokens)) {}
    config::PeopleConfig people_;
    Tokens tokens_;
};

}  // namespace wall::walld
