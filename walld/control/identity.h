// SPDX-License-Identifier: MIT
// Who is at the other end: the kernel says which user a local socket belongs to, a token says it for everybody else.
// Asks the machine for names and groups. One thread, but for what says otherwise.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "walld/wall/person.h"

namespace wall::walld {

class Identities {
public:
    /// Reads the tokens' files; each must hold a secret that others cannot read.
    static Result<Identities> open(const config::PeopleConfig& people);

    /// Asks the name service, which may take its time. Any thread.
    Person of(std::uint32_t user) const;
    /// The person that `token` stands for; `base` if there is none (empty).
    Outcome<Person> with_token(Person base, std::string_view token) const;
    /// Over HTTP everybody of this machine has at least the role that the configuration gives (`local`).
    Outcome<Person> over_http(const Person& base, std::string_view authorization, bool local) const;

private:
    struct Token {
        std::string secret;
        Person person;
    };
    explicit Identities(config::PeopleConfig people) : people_(std::move(people)) {}
    config::PeopleConfig people_;
    std::vector<Token> tokens_;
};

}  // namespace wall::walld
