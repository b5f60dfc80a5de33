// SPDX-License-Identifier: MIT
// A machine's own key, with a certificate that it has signed itself: TLS wants one, the wall's own programs look at no
// more of it than the key, and browsers remember it. Any thread.
#pragma once

#include <filesystem>
#include <string>

#include "common/base/result.h"
#include "common/tls/fingerprint.h"
#include "common/tls/openssl.h"

namespace wall::tls {

class Identity {
public:
    /// A new key on P-256, which browsers know as well.
    static Result<Identity> make();
    /// The one in the file (PEM, readable by its owner alone), or a new one that is kept there, with its certificate.
    /// An error for a file that others can read: whoever has it is this machine.
    static Result<Identity> load_or_make(const std::filesystem::path& file);

    const Fingerprint& fingerprint() const { return fingerprint_; }
    EVP_PKEY* key() const { return key_.get(); }
    X509* certificate() const { return certificate_.get(); }
    /// What browsers show: SHA-256 of the certificate as "AB:CD:...".
    std::string certificate_digest() const;

private:
    Identity(KeyOwner key, CertificateOwner certificate, const Fingerprint& fingerprint)
        : key_(std::move(key)), certificate_(std::move(certificate)), fingerprint_(fingerprint) {}
    static Result<Identity> of_key(KeyOwner key, CertificateOwner certificate = nullptr);
    Result<void> save(const std::filesystem::path& file) const;

    KeyOwner key_;
    CertificateOwner certificate_;
    Fingerprint fingerprint_;
};

/// Of the key in a certificate.
Result<Fingerprint> fingerprint_of(X509* certificate);

}  // namespace wall::tls
