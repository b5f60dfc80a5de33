// SPDX-License-Identifier: MIT
#include "tileserver/partials/partial_box.h"

#include <gtest/gtest.h>

namespace wall::tileserver {
namespace {

constexpr SessionId kSession{1};

std::vector<std::byte> message_of(const PartialKey& key) {
    return encode_partial(key, {{0, 0, 1, 1}, false, {1}, {1}});
}

PartialKey key_of(std::uint32_t sequence, std::uint32_t from = 0) {
    return {SurfaceId(1), sequence, 0, NodeIndex(from), 0};
}

TEST(ABox, KeepsWhatHasComeUntilItIsTaken) {
    PartialBox box;
    const std::vector keys{key_of(1, 0), key_of(1, 1)};
    ASSERT_TRUE(box.put(kSession, message_of(keys[1])));
    EXPECT_FALSE(box.has(kSession, keys));
    ASSERT_TRUE(box.put(kSession, message_of(keys[0])));
    EXPECT_TRUE(box.has(kSession, keys));
    EXPECT_FALSE(box.has(SessionId(2), keys)) << "another session's";
    EXPECT_EQ(box.take(kSession, keys[0]), message_of(keys[0]));
    EXPECT_FALSE(box.take(kSession, keys[0]));
}

TEST(ABox, DropsWhatComesTooLate) {
    PartialBox box;
    ASSERT_TRUE(box.put(kSession, message_of(key_of(1))));
    box.close(kSession, SurfaceId(1), 1, 9);
    EXPECT_TRUE(box.has(kSession, std::vector{key_of(1)})) << "another process's";
    box.close(kSession, SurfaceId(1), 0, 2);
    EXPECT_FALSE(box.take(kSession, key_of(1)));
    ASSERT_TRUE(box.put(kSession, message_of(key_of(2))));
    EXPECT_FALSE(box.take(kSession, key_of(2)));
    ASSERT_TRUE(box.put(kSession, message_of(key_of(3))));
    EXPECT_TRUE(box.take(kSession, key_of(3)));
    box.forget(kSession);
    ASSERT_TRUE(box.put(kSession, message_of(key_of(1)))) << "a session of the same number later";
    EXPECT_TRUE(box.take(kSession, key_of(1)));
}

TEST(ABox, DoesNotWaitForNodesThatAreGone) {
    PartialBox box;
    const std::vector keys{key_of(1, 3), key_of(1, 4)};
    ASSERT_TRUE(box.put(kSession, message_of(keys[0])));
    EXPECT_FALSE(box.has(kSession, keys)) << "nobody has said that it is gone";
    box.lose(kSession, NodeIndex(4));
    EXPECT_TRUE(box.has(kSession, keys));
    EXPECT_FALSE(box.take(kSession, keys[1]));
    ASSERT_TRUE(box.put(kSession, message_of(key_of(2, 4)))) << "it is there again";
    EXPECT_FALSE(box.has(kSession, keys));
}

TEST(ABox, LosesNothingForASessionThatHasEnded) {
    PartialBox box;
    ASSERT_TRUE(box.put(kSession, message_of(key_of(1, 3))));
    box.forget(kSession);
    box.lose(kSession, NodeIndex(3));
    EXPECT_FALSE(box.has(kSession, std::vector{key_of(1, 3)})) << "a later one of that number waits for it";
}

TEST(ABox, KnowsOfNodesThatTheSessionHasNoMore) {
    PartialBox box;
    const std::vector keys{key_of(1, 3)};
    box.set_nodes(kSession, {NodeIndex(2)});
    box.set_nodes(kSession, {NodeIndex(2), NodeIndex(3)});
    EXPECT_FALSE(box.has(kSession, keys));
    box.set_nodes(kSession, {NodeIndex(2)});
    EXPECT_TRUE(box.has(kSession, keys));
    EXPECT_FALSE(box.has(SessionId(2), keys)) << "another session's";
    box.set_nodes(kSession, {NodeIndex(2), NodeIndex(3)});
    EXPECT_FALSE(box.has(kSession, keys)) << "it has come back";
}

TEST(ABox, RefusesWhatIsNone) {
    PartialBox box;
    EXPECT_FALSE(box.put(kSession, std::vector<std::byte>(10)));
}

}  // namespace
}  // namespace wall::tileserver
