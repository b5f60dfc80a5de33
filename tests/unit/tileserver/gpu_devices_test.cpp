// SPDX-License-Identifier: MIT
#include "tileserver/gpu/gpu_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tileserver/gpu/backend.h"

namespace wall::tileserver {
namespace {

using ::testing::HasSubstr;

const std::vector<GpuDevice> kTwo{{nullptr, "0000:17:00.0"}, {nullptr, "0001:65:00.0"}}, kNamelessOne{{nullptr, ""}},
    kNone;

std::string refusal_of(const std::vector<GpuDevice>& gpus, std::string_view wanted) {
    const auto chosen = choose_gpu(gpus, wanted);
    EXPECT_FALSE(chosen) << wanted;
    return chosen ? "" : chosen.error().message;
}

TEST(GpuChoice, IsTheFirstANumberOrAnAddress) {
    EXPECT_EQ(choose_gpu(kTwo, "auto"), 0u);
    EXPECT_EQ(choose_gpu(kTwo, "1"), 1u);
    EXPECT_EQ(choose_gpu(kTwo, "0000:17:00.0"), 0u);
    EXPECT_EQ(choose_gpu(kTwo, "17:00.0"), 0u);
    EXPECT_EQ(choose_gpu(kTwo, "0001:65:00.0"), 1u);
}

TEST(GpuChoice, SaysWhichThereAre) {
    EXPECT_EQ(refusal_of(kTwo, "2"), "there is no GPU '2': there are 0 (0000:17:00.0), 1 (0001:65:00.0)");
    EXPECT_THAT(refusal_of(kTwo, "65:00.0"), HasSubstr("there is no GPU '65:00.0'")) << "in another domain";
    EXPECT_THAT(refusal_of(kNamelessOne, "17:00.0"), HasSubstr("there are 0"));
    EXPECT_THAT(refusal_of(kNamelessOne, ""), HasSubstr("there is no GPU ''"));
    EXPECT_THAT(refusal_of(kNone, "17:00.0"), HasSubstr("none but software renderers"));
}

TEST(GpuChoice, IsTheSoftwareRendererWhereThereIsNothingElse) {
    EXPECT_EQ(choose_gpu(kNone, "auto"), 0u);
    EXPECT_EQ(choose_gpu(kNone, "3"), 0u);
}

TEST(Gpus, AreListedWithTheirRenderers) {
    const auto table = gpu_table();
    if (gpu_devices().empty()) EXPECT_THAT(table, HasSubstr("no GPU here"));
    else EXPECT_THAT(table, HasSubstr("GPU  PCI"));
}

TEST(Gpus, AreOpenedByTheirNumbers) {
    if (!open_egl_backend()) GTEST_SKIP() << "no EGL here";
    EXPECT_TRUE(open_egl_backend("0"));
    const auto wrong = open_egl_backend("99:00.0");
    ASSERT_FALSE(wrong);
    EXPECT_THAT(wrong.error().message, HasSubstr("there is no GPU '99:00.0'"));
}

}  // namespace
}  // namespace wall::tileserver
