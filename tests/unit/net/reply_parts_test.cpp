// SPDX-License-Identifier: MIT
#include "common/net/reply_parts.h"

#include <gtest/gtest.h>

#include "common/net/framing.h"
#include "common/wire/limits.h"

namespace wall::net {
namespace {

proto::OperatorReply about() {
    proto::OperatorReply out;
    out.set_request(7);
    out.set_ok(true);
    return out;
}

/// Through messages as they go over a connection; gives how many there were.
std::size_t send(ReplyParts parts, ReplyJoiner& joiner, std::optional<proto::OperatorReply>& whole) {
    std::size_t count = 0;
    for (auto part = parts.next(); part; part = parts.next(), ++count) {
        EXPECT_FALSE(whole) << "the answer was whole already";
        EXPECT_LE(part->json().size() + part->blob().size(), wire::kControlPart);
        proto::Envelope envelope, received;
        *envelope.mutable_operator_reply() = *part;
        EXPECT_TRUE(received.ParseFromString(frame(envelope)->substr(4))) << "no text is cut within a character";
        auto added = joiner.add(std::move(*received.mutable_operator_reply()));
        EXPECT_TRUE(added);
        whole = std::move(*added);
    }
    return count;
}

TEST(ReplyParts, ASmallAnswerIsOneMessage) {
    ReplyJoiner joiner;
    std::optional<proto::OperatorReply> whole;
    EXPECT_EQ(send({about(), "{}", "he", "ad"}, joiner, whole), 1u);
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->json(), "{}");
    EXPECT_EQ(whole->blob(), "head");
    EXPECT_EQ(whole->request(), 7u);
    EXPECT_TRUE(whole->ok());
}

TEST(ReplyParts, TextsAreCutBetweenCharactersOnly) {
    for (std::size_t size = wire::kControlPart - 3; size < wire::kControlPart + 3; ++size) {
        std::string json = "\"" + std::string(size % 3, 'x');
        while (json.size() < size) json += "\u20ac";  // three bytes each
        json += '"';
        ReplyJoiner joiner;
        std::optional<proto::OperatorReply> whole;
        EXPECT_LE(send({about(), json, "head", "rest"}, joiner, whole), 3u);
        ASSERT_TRUE(whole) << size;
        EXPECT_TRUE(whole->json() == json);
        EXPECT_EQ(whole->blob(), "headrest");
        EXPECT_FALSE(whole->more());
    }
}

TEST(ReplyParts, AnAnswerThatIsLargerThanAMessageComesTogetherAgain) {
    std::string blob(wire::kMaxControlMessage + 5, 'b');
    blob.back() = 'e';
    ReplyJoiner joiner;
    std::optional<proto::OperatorReply> whole;
    EXPECT_EQ(send({about(), "{}", "head", blob}, joiner, whole), wire::kMaxControlMessage / wire::kControlPart + 1);
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->json(), "{}");
    EXPECT_TRUE(whole->blob() == "head" + blob);
}

TEST(ReplyParts, PartsOfTwoAnswersAreNotMixed) {
    ReplyJoiner joiner;
    auto part = about();
    part.set_more(true);
    EXPECT_FALSE(*joiner.add(part));
    part.set_request(8);
    EXPECT_FALSE(joiner.add(part));
}

TEST(ReplyParts, AnAnswerWithoutAnEndIsRefused) {
    ReplyJoiner joiner;
    auto part = about();
    part.set_more(true);
    part.set_json(std::string(32 << 20, ' '));
    bool good = true;
    for (std::uint64_t sent = 0; good && sent <= kMaxReplyJson; sent += part.json().size())
        good = joiner.add(part).has_value();
    EXPECT_FALSE(good);
}

}  // namespace
}  // namespace wall::net
