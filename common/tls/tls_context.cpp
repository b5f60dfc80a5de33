// SPDX-License-Identifier: MIT
#include "common/tls/tls_context.h"

namespace wall::tls {
namespace {

/// AES-128-GCM first: on processors of this century it is the fastest, and as good as need be.
constexpr const char* kCiphers = "TLS_AES_128_GCM_SHA256:TLS_AES_256_GCM_SHA384:TLS_CHACHA20_POLY1305_SHA256";
constexpr const char* kGroups = "X25519:P-256";

/// TLS itself proves that the peer has the certificate's key (RFC 8446, 4.4.3); the rest of it says nothing to us.
int take_any(X509_STORE_CTX* store, void*) {
    X509_STORE_CTX_set_error(store, X509_V_OK);
    return 1;
}

ContextOwner context_for(const Identity& identity) {
    ContextOwner out(SSL_CTX_new(TLS_method()));
    if (!out) return nullptr;
    SSL_CTX* context = out.get();
    const bool good = SSL_CTX_set_min_proto_version(context, TLS1_3_VERSION) == 1 &&
                      SSL_CTX_set_ciphersuites(context, kCiphers) == 1 &&
                      SSL_CTX_set1_groups_list(context, kGroups) == 1 &&
                      SSL_CTX_use_certificate(context, identity.certificate()) == 1 &&
                      SSL_CTX_use_PrivateKey(context, identity.key()) == 1 &&
                      SSL_CTX_set_num_tickets(context, 0) == 1;  // a peer proves its key in every connection
    SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_OFF);
    SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
    SSL_CTX_set_mode(context,
                     SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER | SSL_MODE_RELEASE_BUFFERS);
    return good ? std::move(out) : nullptr;
}

}  // namespace

Result<TlsContext> TlsContext::make(const Identity& identity) {
    auto links = context_for(identity), pages = context_for(identity);
    if (!links || !pages) return fail("TLS cannot be set up: " + openssl_error());
    SSL_CTX_set_verify(links.get(), SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
    SSL_CTX_set_cert_verify_callback(links.get(), take_any, nullptr);
    return TlsContext(std::move(links), std::move(pages), identity);
}

Result<Fingerprint> peer_of(SSL* connection) {
    X509* shown = SSL_get0_peer_certificate(connection);
    if (!shown || SSL_get_verify_result(connection) != X509_V_OK) return fail("the peer has proven no key");
    return fingerprint_of(shown);
}

}  // namespace wall::tls
