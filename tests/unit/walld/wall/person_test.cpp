// SPDX-License-Identifier: MIT
#include "walld/wall/person.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "walld/control/audit.h"

namespace wall::walld {
namespace {

Person user(const char* name, std::uint32_t number, Role role) { return {Person::Kind::unix_user, name, number, role}; }

TEST(Person, MayDoWhatTheRoleAllows) {
    const auto viewer = user("vera", 1, Role::viewer), alice = user("alice", 2, Role::user),
               bob = user("bob", 3, Role::user), olga = user("olga", 4, Role::operator_);
    const Person token{Person::Kind::token, "alice", 0, Role::user}, unknown{};
    for (const auto& who : {viewer, alice, olga, token})
        EXPECT_TRUE(may(who, Need::look, "look", nullptr)) << who.text();
    EXPECT_FALSE(may(unknown, Need::look, "look", nullptr));

    EXPECT_TRUE(may(alice, Need::own, "move session 1", &alice));
    EXPECT_TRUE(may(olga, Need::own, "move session 1", &alice));
    for (const auto& who : {viewer, bob, token, unknown})
        EXPECT_FALSE(may(who, Need::own, "move session 1", &alice)) << who.text();
    EXPECT_FALSE(may(viewer, Need::own, "move session 1", &viewer)) << "a viewer moves nothing";
    EXPECT_FALSE(may({.role = Role::user}, Need::own, "move session 1", &unknown)) << "nobody unknown owns anything";

    EXPECT_TRUE(may(olga, Need::operate, "save a layout", nullptr));
    EXPECT_FALSE(may(alice, Need::operate, "save a layout", nullptr));
}

TEST(Person, IsToldWhyNot) {
    const auto alice = user("alice", 2, Role::user), bob = user("bob", 3, Role::user);
    const auto no = may(bob, Need::own, "place session 3", &alice);
    ASSERT_FALSE(no);
    EXPECT_EQ(no.error().kind, RefusalKind::forbidden);
    EXPECT_EQ(no.error().message, "bob may not place session 3: it belongs to alice");
}

TEST(Audit, IsOneLineThatNobodyCanForge) {
    const auto evil = user("al\"ice\naudit who=root", 2, Role::user);
    const nlohmann::json arguments{{"id", "3\nx"}, {"rect", {0, 0, 1, 1}}};
    const std::string what = "place";
    const Refusal refusal{RefusalKind::forbidden, "no\n\"way\""};
    const auto line = audit_line({evil, "http", what, arguments, &refusal});
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_EQ(line,
              "audit who=\"al\\\"ice\\naudit who=root\" role=user via=http what=place target=\"3\\nx\" "
              "arguments={\"id\":\"3\\nx\",\"rect\":[0,0,1,1]} result=forbidden "
              "reason=\"no\\n\\\"way\\\"\"");
    EXPECT_NE(audit_line({evil, "http", what, arguments, nullptr}).find(" result=ok"), std::string::npos);
    EXPECT_LT(audit_line({evil, "http", what, {{"id", std::string(100000, 'x')}}, nullptr}).size(), 2000u);
}

}  // namespace
}  // namespace wall::walld
