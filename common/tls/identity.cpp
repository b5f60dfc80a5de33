// SPDX-License-Identifier: MIT
#include "common/tls/identity.h"

#include <fcntl.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/sha.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/unique_fd.h"
#include "common/base/whole_file.h"

namespace wall::tls {
namespace {

constexpr const char* kCurve = "P-256";
constexpr const char* kCommonName = "WallGL";
constexpr long kLifetime = 100L * 365 * 24 * 3600;  // seconds; keys end by being revoked, not by a date
constexpr long kMargin = 24 * 3600;                 // before now: clocks of machines differ
constexpr long kX509v3 = 2;
constexpr std::size_t kMaxFile = 16 << 10;  // bytes

tl::unexpected<Error> wrong(const std::filesystem::path& file, const std::string& what) {
    return fail("key " + file.string() + ": " + what);
}

bool name_certificate(X509* certificate) {
    X509_NAME* name = X509_get_subject_name(certificate);
    const auto* text = reinterpret_cast<const unsigned char*>(kCommonName);
    return X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, text, -1, -1, 0) == 1 &&
           X509_set_issuer_name(certificate, name) == 1;
}

CertificateOwner certificate_for(EVP_PKEY* key) {
    CertificateOwner out(X509_new());
    std::uint64_t serial = 0;
    if (!out || RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial) != 1) return nullptr;
    const bool good = X509_set_version(out.get(), kX509v3) == 1 &&
                      ASN1_INTEGER_set_uint64(X509_get_serialNumber(out.get()), serial >> 1 | 1) == 1 &&
                      X509_gmtime_adj(X509_getm_notBefore(out.get()), -kMargin) != nullptr &&
                      X509_gmtime_adj(X509_getm_notAfter(out.get()), kLifetime) != nullptr &&
                      X509_set_pubkey(out.get(), key) == 1 && name_certificate(out.get()) &&
                      X509_sign(out.get(), key, EVP_sha256()) > 0;
    return good ? std::move(out) : nullptr;
}

/// The whole file, if nobody else can read it.
Result<std::string> read_secret(int fd, const std::filesystem::path& file) {
    struct stat info {};
    if (::fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) return wrong(file, "expected a file");
    if ((info.st_mode & 077) != 0) return wrong(file, "expected a file that only its owner can read (chmod 600)");
    std::string text(kMaxFile + 1, '\0');
    const auto n = ::read(fd, text.data(), text.size());
    if (n < 0) return wrong(file, std::strerror(errno));
    text.resize(static_cast<std::size_t>(n));
    if (text.size() > kMaxFile) return wrong(file, "expected a key, not so large a file");
    return text;
}

}  // namespace

std::string openssl_error() {
    const auto code = ERR_get_error();
    ERR_clear_error();
    const char* reason = code ? ERR_reason_error_string(code) : nullptr;
    return reason ? reason : "OpenSSL gives no reason";
}

Result<Fingerprint> fingerprint_of(X509* certificate) {
    unsigned char* der = nullptr;
    const int size = i2d_PUBKEY(X509_get0_pubkey(certificate), &der);
    if (size <= 0) return fail("a certificate without a key: " + openssl_error());
    std::string digest(Fingerprint::kBytes, '\0');
    SHA256(der, static_cast<std::size_t>(size), reinterpret_cast<unsigned char*>(digest.data()));
    OPENSSL_free(der);
    return Fingerprint::from_bytes(digest);
}

Result<Identity> Identity::of_key(KeyOwner key, CertificateOwner certificate) {
    if (!certificate) certificate = certificate_for(key.get());
    if (!certificate) return fail("a certificate cannot be made: " + openssl_error());
    const auto fingerprint = fingerprint_of(certificate.get());
    if (!fingerprint) return tl::unexpected(fingerprint.error());
    return Identity(std::move(key), std::move(certificate), *fingerprint);
}

Result<Identity> Identity::make() {
    KeyOwner key(EVP_EC_gen(kCurve));
    if (!key) return fail("a key cannot be made: " + openssl_error());
    return of_key(std::move(key));
}

Result<Identity> Identity::load_or_make(const std::filesystem::path& file) {
    const UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (!fd && errno != ENOENT) return wrong(file, std::strerror(errno));
    if (!fd) {
        auto made = make();
        if (!made) return made;
        if (auto saved = made->save(file); !saved) return tl::unexpected(saved.error());
        return made;
    }
    const auto text = read_secret(fd.get(), file);
    if (!text) return tl::unexpected(text.error());
    const BioOwner from(BIO_new_mem_buf(text->data(), static_cast<int>(text->size())));
    KeyOwner key(PEM_read_bio_PrivateKey(from.get(), nullptr, nullptr, nullptr));
    if (!key) return wrong(file, "not a private key in PEM: " + openssl_error());
    CertificateOwner kept(PEM_read_bio_X509(from.get(), nullptr, nullptr, nullptr));
    const bool known = kept && X509_check_private_key(kept.get(), key.get()) == 1;
    ERR_clear_error();
    if (known) return of_key(std::move(key), std::move(kept));
    auto out = of_key(std::move(key));
    if (!out) return out;
    if (auto saved = out->save(file); !saved) return tl::unexpected(saved.error());
    return out;
}

std::string Identity::certificate_digest() const {
    unsigned char digest[SHA256_DIGEST_LENGTH];
    unsigned size = 0;
    std::string out;
    if (X509_digest(certificate_.get(), EVP_sha256(), digest, &size) != 1) return out;
    constexpr char kDigits[] = "0123456789ABCDEF";
    for (unsigned i = 0; i < size; ++i) {
        if (i != 0) out += ':';
        out += {kDigits[digest[i] >> 4], kDigits[digest[i] & 15]};
    }
    return out;
}

Result<void> Identity::save(const std::filesystem::path& file) const {
    const BioOwner memory(BIO_new(BIO_s_mem()));
    if (PEM_write_bio_PrivateKey(memory.get(), key_.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1 ||
        PEM_write_bio_X509(memory.get(), certificate_.get()) != 1)
        return wrong(file, openssl_error());
    char* text = nullptr;
    const auto size = static_cast<std::size_t>(BIO_get_mem_data(memory.get(), &text));
    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);  // what follows says why not
    auto written = write_whole(file, {text, size}, 0600);
    return written ? written : wrong(file, written.error().message);
}

}  // namespace wall::tls
