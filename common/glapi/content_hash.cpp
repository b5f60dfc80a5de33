// SPDX-License-Identifier: MIT
// The low-level interface of OpenSSL's libcrypto, linked statically: it uses the processor's SHA instructions (1.7 GB/s
// on one core), and 30 kB of it end up in a foreign process; the EVP interface would bring megabytes and its own
// clean-up at exit.
#define OPENSSL_SUPPRESS_DEPRECATED
#include "common/glapi/content_hash.h"

#include <openssl/sha.h>

namespace wall::glapi {

struct ContentHash::Digest {
    SHA256_CTX context;
};

ContentHash::ContentHash() : digest_(std::make_unique<Digest>()) { SHA256_Init(&digest_->context); }
ContentHash::~ContentHash() = default;
ContentHash::ContentHash(ContentHash&&) noexcept = default;
ContentHash& ContentHash::operator=(ContentHash&&) noexcept = default;

void ContentHash::add(std::span<const std::byte> bytes) {
    SHA256_Update(&digest_->context, bytes.data(), bytes.size());
}

ContentKey ContentHash::finish() {
    static_assert(sizeof(ContentKey) == SHA256_DIGEST_LENGTH);
    ContentKey key;
    SHA256_Final(reinterpret_cast<unsigned char*>(key.data()), &digest_->context);
    return key;
}

}  // namespace wall::glapi
