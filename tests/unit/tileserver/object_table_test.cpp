// SPDX-License-Identifier: MIT
// One table for all kinds: who is found under an id, what they count for, and when a lookup must be made anew.
#include "tileserver/objects/object_table.h"

#include <gtest/gtest.h>

namespace wall::tileserver {
namespace {

/// Counts for as much as it is told.
template <ObjectKind K>
class Weight final : public ObjectOf<K> {
public:
    explicit Weight(ObjectAccount& account, int* alive = nullptr) : ObjectOf<K>(account), alive_(alive) {
        if (alive_ != nullptr) ++*alive_;
    }
    ~Weight() override {
        if (alive_ != nullptr) --*alive_;
    }
    [[nodiscard]] bool weigh(std::uint64_t bytes) { return this->has_content(bytes); }
    bool could_weigh(std::uint64_t bytes, std::uint64_t instead_of) const { return this->affords(bytes, instead_of); }
    void rename() { this->renamed(); }

private:
    int* alive_;
};
using Texture = Weight<ObjectKind::texture>;
using ListRun = Weight<ObjectKind::run>;

constexpr ClientName kOne(1), kTwo(2);

TEST(ObjectTable, FindsWhatWasMade) {
    ObjectTable table;
    Texture* made = *table.make<Texture>(kOne);
    EXPECT_EQ(table.find<Texture>(kOne), made);
    EXPECT_EQ(*table.make<Texture>(kOne), made) << "no second one";
    EXPECT_EQ(*table.get<Texture>(kOne), made);
    EXPECT_EQ(table.size(), 1u);
    EXPECT_EQ(table.find<Texture>(kTwo), nullptr);
    EXPECT_EQ(*table.look_up<Texture>(kTwo), nullptr);
    EXPECT_EQ(table.get<Texture>(kTwo).error().message, "there is no texture 2");
}

TEST(ObjectTable, AnIdOfAnotherKindIsAnError) {
    ObjectTable table;
    ASSERT_TRUE(table.make<Texture>(kOne));
    EXPECT_EQ(table.find<ListRun>(kOne), nullptr);
    constexpr const char* kWhy = "object 1 is a texture, not a run";
    EXPECT_EQ(table.look_up<ListRun>(kOne).error().message, kWhy);
    EXPECT_EQ(table.get<ListRun>(kOne).error().message, kWhy);
    EXPECT_EQ(table.make<ListRun>(kOne).error().message, kWhy);
}

TEST(ObjectTable, DefaultObjectsAreNoIds) {
    ObjectTable table;
    EXPECT_FALSE(table.make<ListRun>(ClientName(0)));
    const auto first = ObjectKey::default_object(ObjectKind::texture, 0),
               second = ObjectKey::default_object(ObjectKind::texture, 1);
    ASSERT_TRUE(table.make<Texture>(first));
    EXPECT_EQ(table.find<Texture>(second), nullptr);
    EXPECT_EQ(table.find<ListRun>(ObjectKey::default_object(ObjectKind::run, 0)), nullptr);
    EXPECT_EQ(table.find<Texture>(kOne), nullptr);
    table.erase(ClientName(0));
    EXPECT_NE(table.find<Texture>(first), nullptr) << "nobody can delete it";
}

TEST(ObjectTable, DeletesAnyKindAndAllAtTheEnd) {
    int alive = 0;
    {
        ObjectTable table;
        ASSERT_TRUE(table.make<Texture>(kOne, &alive) && table.make<ListRun>(kTwo, &alive));
        table.erase(kTwo);
        table.erase(ClientName(77));
        EXPECT_EQ(alive, 1);
        EXPECT_EQ(table.find<ListRun>(kTwo), nullptr);
    }
    EXPECT_EQ(alive, 0);
}

TEST(ObjectTable, BytesAreOfAllKindsTogether) {
    ObjectTable table;
    Texture* texture = *table.make<Texture>(kOne);
    ListRun* run = *table.make<ListRun>(kTwo);
    EXPECT_TRUE(texture->weigh(1000) && run->weigh(500) && texture->weigh(200));
    EXPECT_EQ(table.bytes(), 2 * kLeastObjectBytes + 700);
    EXPECT_EQ(run->bytes(), kLeastObjectBytes + 500);
    table.erase(kOne);
    EXPECT_EQ(table.bytes(), kLeastObjectBytes + 500);
}

TEST(ObjectTable, ASessionHasABudget) {
    ObjectTable table;
    Texture* texture = *table.make<Texture>(kOne);
    ListRun* run = *table.make<ListRun>(kTwo);
    constexpr std::uint64_t kMost = kMaxObjectBytes - 2 * kLeastObjectBytes;
    EXPECT_TRUE(texture->weigh(kMost));
    EXPECT_FALSE(table.affords(1));
    EXPECT_TRUE(texture->could_weigh(kMost, kMost)) << "for what it has already";
    EXPECT_FALSE(texture->could_weigh(kMost + 1, kMost));
    EXPECT_FALSE(run->weigh(1)) << "another kind has taken it";
    EXPECT_FALSE(table.make<ListRun>(ClientName(3)));
    EXPECT_FALSE(table.affords(~std::uint64_t{0})) << "sums that are too large for a number";
    EXPECT_TRUE(texture->weigh(0) && table.make<ListRun>(ClientName(3)));
}

TEST(ObjectTable, ABudgetMayBeLess) {
    ObjectTable table;
    table.set_limits(10 * kLeastObjectBytes, 2);
    Texture* texture = *table.make<Texture>(kOne);
    ASSERT_TRUE(table.make<ListRun>(kTwo));
    EXPECT_FALSE(texture->weigh(9 * kLeastObjectBytes));
    EXPECT_TRUE(texture->weigh(8 * kLeastObjectBytes));
    const auto third = table.make<ListRun>(ClientName(3));
    ASSERT_FALSE(third);
    EXPECT_EQ(third.error().message, too_much("objects"));
    table.erase(kTwo);
    EXPECT_TRUE(table.make<ListRun>(ClientName(3)));
}

TEST(ObjectTable, AVersionIsOfAKind) {
    ObjectTable table;
    const auto versions = [&table] {
        return std::pair(table.version(ObjectKind::texture), table.version(ObjectKind::run));
    };
    auto before = versions();
    const auto changed = [&] {
        const auto now = versions();
        const auto were = std::exchange(before, now);
        return std::pair(now.first != were.first, now.second != were.second);
    };
    Texture* texture = *table.make<Texture>(kOne);
    EXPECT_EQ(changed(), std::pair(true, false)) << "made";
    ASSERT_TRUE(texture->weigh(7) && table.make<Texture>(kOne));
    EXPECT_EQ(changed(), std::pair(false, false)) << "the same as before to whoever looks it up";
    texture->rename();
    EXPECT_EQ(changed(), std::pair(true, false));
    table.erase(kOne);
    EXPECT_EQ(changed(), std::pair(true, false)) << "deleted";
}

}  // namespace
}  // namespace wall::tileserver
