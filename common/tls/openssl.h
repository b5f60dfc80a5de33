// SPDX-License-Identifier: MIT
// OpenSSL's objects with owners, and its errors as sentences. For the sources of common/tls and who drives OpenSSL
// itself (common/net/stream.cpp). Any thread.
#pragma once

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <memory>
#include <string>

namespace wall::tls {

template <auto free_it>
struct Free {
    void operator()(auto* object) const { free_it(object); }
};
using KeyOwner = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using CertificateOwner = std::unique_ptr<X509, Free<X509_free>>;
using ContextOwner = std::unique_ptr<SSL_CTX, Free<SSL_CTX_free>>;
using BioOwner = std::unique_ptr<BIO, Free<BIO_free_all>>;

/// What OpenSSL says of the last failure in this thread; its queue of errors is empty then.
std::string openssl_error();

}  // namespace wall::tls
