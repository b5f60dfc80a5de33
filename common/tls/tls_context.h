// SPDX-License-Identifier: MIT
// How connections between machines are made: TLS 1.3 and nothing older, and both ends prove that they have the key of
// the certificate they show. Whose key that is, is for the caller to decide: certificates are taken as they are, and
// their fingerprint is compared with what is known. Any thread.
#pragma once

#include <string>

#include "common/base/result.h"
#include "common/tls/fingerprint.h"
#include "common/tls/identity.h"
#include "common/tls/openssl.h"

namespace wall::tls {

/// Of one machine, for all its connections.
class TlsContext {
public:
    /// `identity` is used up to the end of this call only.
    static Result<TlsContext> make(const Identity& identity);

    /// For links between the wall's own programs: a peer without a key is cut off in the handshake.
    SSL_CTX* links() const { return links_.get(); }
    /// For browsers, which show none; peers are not asked for a key.
    SSL_CTX* pages() const { return pages_.get(); }
    const Fingerprint& fingerprint() const { return fingerprint_; }
    /// As browsers show it of pages().
    const std::string& certificate_digest() const { return certificate_digest_; }

private:
    TlsContext(ContextOwner links, ContextOwner pages, const Identity& own)
        : links_(std::move(links)),
          pages_(std::move(pages)),
          fingerprint_(own.fingerprint()),
          certificate_digest_(own.certificate_digest()) {}
    ContextOwner links_, pages_;
    Fingerprint fingerprint_;
    std::string certificate_digest_;
};

/// The fingerprint of the key that the peer has proven; an error before the handshake, and for a peer without one.
Result<Fingerprint> peer_of(SSL* connection);

}  // namespace wall::tls
