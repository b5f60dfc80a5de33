// SPDX-License-Identifier: MIT
// The text of an assembly program as tokens (GL_ARB_vertex_program, 2.14.2; GL_ARB_fragment_program, 3.11.2): names,
// words, numbers and single characters. What looks into a program looks at these, and never at its raw text. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace wall::tileserver {

struct AssemblyToken {
    std::string_view text;
    std::size_t at = 0;  ///< where it begins in the source
    std::size_t behind() const { return at + text.size(); }
};

/// Comments and blanks are left out; the first one is "!!ARBvp1.0" or the like. They refer to `source`.
std::vector<AssemblyToken> assembly_tokens(std::string_view source);

/// Goes over tokens; behind the last one is an empty text.
class AssemblyCursor {
public:
    explicit AssemblyCursor(std::span<const AssemblyToken> tokens) : tokens_(tokens) {}

    bool at_end() const { return at_ >= tokens_.size(); }
    std::size_t place() const { return at_; }
    std::string_view peek(std::size_t ahead = 0) const {
        return at_ + ahead < tokens_.size() ? tokens_[at_ + ahead].text : std::string_view();
    }
    std::string_view take() {
        const std::string_view text = peek();
        if (!at_end()) ++at_;
        return text;
    }
    /// Passes over the next token if it is this one.
    bool take(std::string_view wanted) {
        if (peek() != wanted || at_end()) return false;
        ++at_;
        return true;
    }
    /// The same of a whole number without a sign.
    std::optional<unsigned> take_index();
    /// Passes over "[", a whole number and "]"; nothing, and it stays: these do not come.
    std::optional<unsigned> take_subscript();
    /// To the end of the statement, and over its semicolon.
    void skip_statement();
    /// Over the statements "OPTION name;" behind the first token. Calls use(name) with each.
    template <class Use>
    void take_options(Use&& use) {
        while (peek() == "OPTION" && peek(2) == ";") {
            use(peek(1));
            at_ += 3;
        }
    }

private:
    std::span<const AssemblyToken> tokens_;
    std::size_t at_ = 0;
};

}  // namespace wall::tileserver
