// SPDX-License-Identifier: MIT
#include "client_lib/process/log.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

TEST(Complaint, IsOneHarmlessLineWhateverANodeSaysAndIsMadeOnce) {
    testing::internal::CaptureStderr();
    for (int i = 0; i < 2; ++i)
        complain_once("node refused: \x1b[2Jno\nwallgl: all is well" + std::string(1000, '!'), "refusals");
    const auto said = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(said.starts_with("wallgl: node refused: \\x1b[2Jno\\nwallgl: all is well!!!")) << said;
    EXPECT_TRUE(said.ends_with("!!!...\n")) << said;
    EXPECT_LT(said.size(), 600u);
}

}  // namespace
}  // namespace wall::client
