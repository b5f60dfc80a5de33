// SPDX-License-Identifier: MIT
#include "common/tls/secret.h"

#include <openssl/crypto.h>

namespace wall::tls {

bool same_secret(std::string_view a, std::string_view b) {
    return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace wall::tls
