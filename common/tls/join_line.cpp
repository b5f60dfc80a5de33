// SPDX-License-Identifier: MIT
#include "common/tls/join_line.h"

#include <algorithm>

namespace wall::tls {
namespace {

constexpr std::string_view kVersion = "wallgl1.";

/// What stands behind the last dot, which `text` ends before then.
std::string_view take_last(std::string_view& text) {
    const auto dot = text.rfind('.');
    if (dot == std::string_view::npos) return {};
    const auto last = text.substr(dot + 1);
    text = text.substr(0, dot);
    return last;
}

/// What names and numbers of machines are made of.
bool host_ok(std::string_view host) {
    const auto plain = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-' ||
               c == '_' || c == ':' || c == '%';
    };
    return !host.empty() && std::ranges::all_of(host, plain);
}

}  // namespace

std::string JoinLine::text() const {
    return std::string(kVersion) + walld.text() + "." + fingerprint.text() + "." + to_base64url(secret);
}

Result<JoinLine> JoinLine::parse(std::string_view line) {
    const auto wrong = [](const std::string& what) {
        return fail("not a line of `wallctl join-token`, which begins with " + std::string(kVersion) + ": " + what);
    };
    if (!line.starts_with(kVersion)) return wrong("it begins otherwise");
    auto rest = line.substr(kVersion.size());
    const auto secret = from_base64url(take_last(rest));
    if (!secret || secret->size() != kSecretBytes) return wrong("its end is cut off, or changed");
    const auto fingerprint = Fingerprint::parse(take_last(rest));
    if (!fingerprint) return wrong(fingerprint.error().message);
    auto walld = Address::parse(rest);
    if (!walld) return wrong(walld.error().message);
    if (walld->is_unix()) return wrong("walld's address is a socket of one machine: expected HOST:PORT");
    if (!host_ok(walld->host)) return wrong("walld's host is neither a name nor a number");
    return JoinLine{std::move(*walld), *fingerprint, *secret};
}

}  // namespace wall::tls
