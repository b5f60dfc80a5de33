// SPDX-License-Identifier: MIT
// What names a machine: the SHA-256 of its public key (SubjectPublicKeyInfo in DER, as in RFC 7469, 2.4). There are no
// certificate authorities and no host names: who knows a fingerprint knows whom it speaks to. Any thread.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace wall::tls {

class Fingerprint {
public:
    static constexpr std::size_t kBytes = 32, kCharacters = 43;

    Fingerprint() = default;  ///< of nobody
    /// Of text(): 43 characters of base64url.
    static Result<Fingerprint> parse(std::string_view text);
    /// As it travels: 32 bytes.
    static Result<Fingerprint> from_bytes(std::string_view bytes);

    std::string text() const;
    std::string bytes() const;
    bool operator==(const Fingerprint&) const = default;
    auto operator<=>(const Fingerprint&) const = default;

private:
    std::array<std::uint8_t, kBytes> value_{};
};

/// Bytes as base64url without padding (RFC 4648, 5).
std::string to_base64url(std::string_view bytes);
/// Nothing but whole, canonical base64url is taken.
Result<std::string> from_base64url(std::string_view text);

}  // namespace wall::tls
