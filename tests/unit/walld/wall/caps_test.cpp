// SPDX-License-Identifier: MIT
#include "walld/wall/caps.h"

#include <gtest/gtest.h>

#include <vector>

namespace wall::walld {
namespace {

proto::GlCaps caps(const char* version, const char* extensions,
                   std::vector<std::pair<std::uint32_t, std::vector<double>>> limits) {
    proto::GlCaps out;
    out.set_vendor("Mesa");
    out.set_version(version);
    out.set_extensions(extensions);
    for (const auto& [name, values] : limits) {
        auto* limit = out.add_limits();
        limit->set_name(name);
        for (const auto value : values) limit->add_values(value);
    }
    return out;
}

TEST(Caps, TheWallCanDoWhatEveryNodeCan) {
    const auto a = caps("4.5 Mesa", "GL_A GL_B GL_C", {{0x0D33, {16384}}, {0x846D, {1, 255}}, {0x1234, {1}}});
    const auto b = caps("3.3.1 Other", "GL_C GL_A", {{0x0D33, {8192}}, {0x846D, {0.5, 64}}});
    const proto::GlCaps* both[] = {&a, &b};
    const auto common = common_caps(both);
    EXPECT_EQ(common.vendor(), "Mesa");
    EXPECT_EQ(common.version(), "3.3.1 Other");
    EXPECT_EQ(common.extensions(), "GL_A GL_C");
    ASSERT_EQ(common.limits_size(), 2) << "a limit that one does not know is no limit of the wall";
    EXPECT_EQ(common.limits(0).values(0), 8192);
    EXPECT_EQ(common.limits(1).values(0), 1) << "a range's lower end is the higher one";
    EXPECT_EQ(common.limits(1).values(1), 64);
}

TEST(Caps, OneNodeIsItself) {
    const auto a = caps("4.5", "GL_A", {{1, {2}}});
    const proto::GlCaps* one[] = {&a};
    EXPECT_EQ(common_caps(one).SerializeAsString(), a.SerializeAsString());
}

}  // namespace
}  // namespace wall::walld
