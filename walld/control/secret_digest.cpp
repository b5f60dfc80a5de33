// SPDX-License-Identifier: MIT
#include "walld/control/secret_digest.h"

#include <openssl/sha.h>

#include <algorithm>

#include "common/tls/fingerprint.h"

namespace wall::walld {

SecretDigest SecretDigest::of(std::string_view secret) {
    SecretDigest out;
    static_assert(sizeof out.value_ == SHA256_DIGEST_LENGTH);
    SHA256(reinterpret_cast<const unsigned char*>(secret.data()), secret.size(), out.value_.data());
    return out;
}

Result<SecretDigest> SecretDigest::parse(std::string_view text) {
    const auto bytes = tls::from_base64url(text);
    SecretDigest out;
    if (!bytes || bytes->size() != out.value_.size()) return fail("expected the 43 characters of a digest");
    std::ranges::copy(*bytes, out.value_.begin());
    return out;
}

std::string SecretDigest::text() const { return tls::to_base64url(std::string(value_.begin(), value_.end())); }

}  // namespace wall::walld
