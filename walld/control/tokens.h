// SPDX-License-Identifier: MIT
// The secrets that stand for people (`[[people.token]]`), and those of them that an operator has revoked. What is
// revoked is a secret: a token whose file has another one is good again. That is written down
// (FOLDER/revoked_tokens.json), since nobody else could tell it to the next walld. One thread.
#pragma once

#include <filesystem>
#include <set>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "walld/control/secret_digest.h"
#include "walld/wall/person.h"

namespace wall::walld {

class Tokens {
public:
    struct Token {
        Person person;
        SecretDigest secret;
    };
    /// Reads the tokens' files; each must hold a secret that others cannot read. `folder`: walld's state; empty: no
    /// token can be revoked.
    static Result<Tokens> open(const std::vector<config::TokenConfig>& tokens, const std::filesystem::path& folder);

    /// In the order of wall.toml.
    const std::vector<Token>& all() const { return tokens_; }
    bool is_revoked(const Token& token) const { return revoked_.contains(token.secret); }
    /// Whom the secret stands for now.
    Outcome<Person> find(const SecretDigest& secret) const;
    /// Its secret is nobody's any more; again is no error.
    Outcome<Person> revoke(std::string_view name);

private:
    explicit Tokens(std::filesystem::path file) : file_(std::move(file)) {}

    std::filesystem::path file_;  ///< empty: nothing can be kept
    std::vector<Token> tokens_;
    std::set<SecretDigest> revoked_;  ///< also of tokens that wall.toml has no more
};

}  // namespace wall::walld
