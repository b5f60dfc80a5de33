// SPDX-License-Identifier: MIT
#include "common/tls/identity.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "common/tls/tls_context.h"
#include "tests/support/temporary_folder.h"

namespace wall::tls {
namespace {

mode_t mode_of(const std::string& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0 ? info.st_mode & 07777 : 0;
}

TEST(Identity, IsMadeOnceAndKeptForItsOwnerAlone) {
    const test::TemporaryFolder folder;
    const auto path = folder.file("state/key.pem");
    const auto first = Identity::load_or_make(path), again = Identity::load_or_make(path);
    ASSERT_TRUE(first) << first.error().message;
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(first->fingerprint(), again->fingerprint());
    EXPECT_EQ(first->certificate_digest(), again->certificate_digest()) << "browsers know it again";
    EXPECT_EQ(first->certificate_digest().size(), 32u * 3 - 1);
    EXPECT_EQ(mode_of(path), 0600u);
    EXPECT_NE(Identity::make()->fingerprint(), first->fingerprint());
}

TEST(Identity, WithoutItsCertificateGetsANewOneThatIsKept) {
    const test::TemporaryFolder folder;
    const auto path = folder.file("key.pem");
    const auto first = Identity::load_or_make(path);
    ASSERT_TRUE(first);
    std::ifstream file(path);
    std::string text(std::istreambuf_iterator<char>(file), {});
    const auto certificate = text.find("-----BEGIN CERTIFICATE-----");
    ASSERT_NE(certificate, std::string::npos);
    std::ofstream(path) << text.substr(0, certificate);
    const auto second = Identity::load_or_make(path), third = Identity::load_or_make(path);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ(second->fingerprint(), first->fingerprint());
    EXPECT_NE(second->certificate_digest(), first->certificate_digest());
    EXPECT_EQ(third->certificate_digest(), second->certificate_digest());
    // Somebody else's is none.
    const auto other = folder.file("other.pem");
    ASSERT_TRUE(Identity::load_or_make(other));
    std::ifstream others(other);
    const std::string foreign(std::istreambuf_iterator<char>(others), {});
    std::ofstream(path) << text.substr(0, certificate) << foreign.substr(foreign.find("-----BEGIN CERTIFICATE-----"));
    EXPECT_EQ(Identity::load_or_make(path)->fingerprint(), first->fingerprint());
}

TEST(Identity, ThatOthersCanReadIsRefused) {
    const test::TemporaryFolder folder;
    const auto path = folder.file("key.pem");
    ASSERT_TRUE(Identity::load_or_make(path));
    ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
    const auto refused = Identity::load_or_make(path);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("chmod 600"), std::string::npos) << refused.error().message;
}

TEST(Identity, ThatIsNoKeyIsAnErrorThatNamesTheFile) {
    const test::TemporaryFolder folder;
    const auto path = folder.file("key.pem");
    std::ofstream(path) << "-----BEGIN PRIVATE KEY-----\nAAAA\n-----END PRIVATE KEY-----\n";
    ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
    const auto refused = Identity::load_or_make(path);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find(path), std::string::npos) << refused.error().message;
}

TEST(Identity, MakesContextsOfTls13Only) {
    const auto identity = Identity::make();
    ASSERT_TRUE(identity);
    const auto context = TlsContext::make(*identity);
    ASSERT_TRUE(context) << context.error().message;
    EXPECT_EQ(context->fingerprint(), identity->fingerprint());
    for (SSL_CTX* one : {context->links(), context->pages()}) {
        EXPECT_EQ(SSL_CTX_get_min_proto_version(one), TLS1_3_VERSION);
        EXPECT_EQ(*fingerprint_of(SSL_CTX_get0_certificate(one)), identity->fingerprint());
    }
}

}  // namespace
}  // namespace wall::tls
