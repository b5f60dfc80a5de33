// SPDX-License-Identifier: MIT
#include "tileserver/io/output_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "walld/wall/messages.h"

namespace wall::tileserver {
namespace {

geom::TileOutput everything() {
    geom::TileOutput out{.rotation = 270, .width = 1920, .height = 1080};
    out.warp = std::make_shared<const geom::Warp>(
        geom::Warp{.columns = 2, .rows = 2, .points = {{0, 0}, {1, 0}, {0, 1}, {0.9f, 1}}});
    out.blend = geom::Blend{{1, 2, 3, 4}, 2.4f, 0.01f};
    out.light =
        std::make_shared<const geom::LightMap>(geom::LightMap{{2, 1, 3, {1, 2, 3, 4, 5, 6}}, {1, 2, 1, {7, 8}}});
    out.color = geom::ColorCorrection{{1, 0.1f, 0, 0, 1, 0, 0, 0, 1}, 2.1f, {{{0, 1}, {}, {0, 0.5f, 1}}}};
    return out;
}

TEST(OutputMessage, ArrivesAsItWasSent) {
    const auto arrived = output_of(walld::to_proto(everything()));
    ASSERT_TRUE(arrived) << arrived.error().message;
    EXPECT_TRUE(**arrived == everything());
    auto with_homography = everything();
    with_homography.warp =
        std::make_shared<const geom::Warp>(geom::Warp{.homography = {1, 0.1f, 0, 0, 1, 0, 0.2f, 0, 1}});
    EXPECT_TRUE(**output_of(walld::to_proto(with_homography)) == with_homography);
    auto with_hole = everything();
    with_hole.warp = std::make_shared<const geom::Warp>(
        geom::Warp{.columns = 2, .rows = 2, .points = {{NAN, NAN}, {1, 0}, {0, 1}, {1, 1}}});
    const auto hole = output_of(walld::to_proto(with_hole));
    ASSERT_TRUE(hole) << hole.error().message;
    EXPECT_TRUE(std::isnan((*hole)->warp->points[0].x));
    const auto plain = geom::plain_output({0, 0, 5, 6});
    EXPECT_TRUE(**output_of(walld::to_proto(plain)) == plain);
}

TEST(PatternMessage, IsATestPictureOrNone) {
    proto::TilePattern told;
    EXPECT_EQ(pattern_of(told), nullptr);
    told.set_kind(proto::TilePattern::NAMES);
    told.set_label_width(2);
    told.set_label_height(3);
    told.set_label("123456");
    ASSERT_TRUE(pattern_of(told));
    EXPECT_EQ(pattern_of(told)->label.bytes, "123456");
    told.set_label_height(4);
    EXPECT_TRUE(pattern_of(told)->label.bytes.empty()) << "a label that is no picture is none";
    told.set_label_width(1u << 31);
    told.set_label_height(2);
    EXPECT_TRUE(pattern_of(told)->label.bytes.empty());
    told.set_kind(proto::TilePattern::CODE);
    told.set_bit(99);
    EXPECT_LE(pattern_of(told)->bit, 15u);
    told.set_kind(static_cast<proto::TilePattern::Kind>(77));
    EXPECT_EQ(pattern_of(told), nullptr) << "of a newer walld";
}

TEST(OutputMessage, IsRefusedIfNoOutputIsThat) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const std::vector<std::function<void(proto::TileOutput&)>> changes{
        [](auto& o) { o.set_rotation(45); },
        [](auto& o) { o.set_rotation(360); },
        [](auto& o) { o.set_width(0); },
        [](auto& o) { o.set_height(1u << 31); },
        [](auto& o) { o.mutable_warp()->set_columns(1); },
        [](auto& o) { o.mutable_warp()->set_columns(0); },
        [](auto& o) { o.mutable_warp()->set_rows(1u << 30); },
        [](auto& o) { o.mutable_warp()->add_points(1); },
        [=](auto& o) { o.mutable_warp()->set_points(3, kNone); },
        [](auto& o) { o.mutable_blend()->set_left(-1); },
        [=](auto& o) { o.mutable_blend()->set_top(kNone); },
        [](auto& o) { o.mutable_blend()->set_gamma(0); },
        [=](auto& o) { o.mutable_blend()->set_black(kNone); },
        [](auto& o) { o.mutable_share()->set_width(3); },
        [](auto& o) { o.mutable_share()->set_channels(2); },
        [](auto& o) { o.mutable_lift()->set_height(0); },
        [](auto& o) { o.mutable_lift()->set_width(1u << 31), o.mutable_lift()->set_height(1u << 31); },
        [](auto& o) { o.mutable_lift()->clear_values(); },
        [](auto& o) { o.mutable_color()->add_matrix(1); },
        [=](auto& o) { o.mutable_color()->set_matrix(0, kNone); },
        [=](auto& o) { o.mutable_color()->set_gamma(kNone); },
        [](auto& o) { o.mutable_color()->add_green(1); },
        [](auto& o) { o.mutable_color()->set_red(0, 2); },
        [](auto& o) {
            for (int i = 0; i < 300; ++i) o.mutable_color()->add_blue(1);
        },
    };
    for (std::size_t i = 0; i < changes.size(); ++i) {
        auto told = walld::to_proto(everything());
        changes[i](told);
        EXPECT_FALSE(output_of(told)) << "change " << i;
    }
}

}  // namespace
}  // namespace wall::tileserver
