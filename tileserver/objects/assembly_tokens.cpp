// SPDX-License-Identifier: MIT
#include "tileserver/objects/assembly_tokens.h"

#include <algorithm>
#include <charconv>

namespace wall::tileserver {
namespace {

// Not those of <cctype>, which depend on the locale.
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool in_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_' || c == '$'; }
bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

class Scanner {
public:
    explicit Scanner(std::string_view text) : text_(text) {}

    std::vector<AssemblyToken> run() {
        if (text_.starts_with("!!")) add(std::min(text_.find_first_of(" \t\r\n#", 0), text_.size()));
        while (at_ < text_.size()) step();
        return std::move(tokens_);
    }

private:
    void step() {
        const char c = text_[at_];
        if (is_blank(c)) ++at_;
        else if (c == '#') at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
        else if (is_digit(c) || (c == '.' && is_digit(next(1)) && !follows_name())) add(number_end());
        else if (in_name(c)) add(name_end(at_));
        else add(at_ + (text_.substr(at_, 2) == ".." ? 2 : 1));
    }
    char next(std::size_t ahead) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
    /// A point there picks something out of what stands before it.
    bool follows_name() const {
        if (at_ == 0) return false;
        const char before = text_[at_ - 1];
        return in_name(before) || before == ']';
    }
    void add(std::size_t behind) {
        tokens_.push_back({text_.substr(at_, behind - at_), at_});
        at_ = behind;
    }
    std::size_t name_end(std::size_t from) const {
        while (from < text_.size() && in_name(text_[from])) ++from;
        return from;
    }
    /// "1", "1.5e-3", and of "1..3" the first; also "2D", which is a word.
    std::size_t number_end() const {
        std::size_t end = name_end(at_);
        if (end < text_.size() && text_[end] == '.' && text_.substr(end, 2) != "..") end = name_end(end + 1);
        const char last = text_[end - 1];
        const bool goes_on = (last == 'e' || last == 'E') && end + 1 < text_.size() && is_digit(text_[end + 1]) &&
                             (text_[end] == '+' || text_[end] == '-');
        return goes_on ? name_end(end + 1) : end;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::vector<AssemblyToken> tokens_;
};

}  // namespace

std::vector<AssemblyToken> assembly_tokens(std::string_view source) { return Scanner(source).run(); }

std::optional<unsigned> AssemblyCursor::take_index() {
    const std::string_view text = peek();
    unsigned value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    ++at_;
    return value;
}

std::optional<unsigned> AssemblyCursor::take_subscript() {
    const std::size_t before = at_;
    if (take("["))
        if (const auto index = take_index(); index && take("]")) return index;
    at_ = before;
    return std::nullopt;
}

void AssemblyCursor::skip_statement() {
    while (!at_end() && take() != ";") {
    }
}

}  // namespace wall::tileserver
