// SPDX-License-Identifier: MIT
// Small floating point numbers: values of the specification, there and back.
#include "client_lib/objects/small_floats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wall::client {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(SmallFloats, EveryHalfSurvives) {
    for (unsigned half = 0; half < 0x10000; ++half) {
        const float value = half_to_float(static_cast<std::uint16_t>(half));
        if (std::isnan(value)) continue;
        EXPECT_EQ(float_to_half(value), half) << value;
    }
    EXPECT_EQ(float_to_half(65520.0f), 0x7c00) << "rounds to infinity";
    EXPECT_EQ(float_to_half(1.0f / 3), 0x3555);
    EXPECT_EQ(float_to_half(2.0f / 3), 0x3955 + 0) << "0.66650 is nearer than 0.66699";
    EXPECT_EQ(float_to_half_cut(0.6825397f), 0x3975);
    EXPECT_EQ(float_to_half(0.6825397f), 0x3976);
    EXPECT_EQ(float_to_half_cut(-1e9f), 0xfbff) << "the largest, not infinity";
}

TEST(SmallFloats, EveryShortFloatSurvives) {
    for (std::uint32_t bits = 0; bits < 0x7c0; ++bits) {  // all that are no infinity and no NaN
        const Rgb colors = from_short_floats(bits | bits << 11 | (bits >> 1) << 22);
        const std::uint32_t again = to_short_floats(colors);
        if (bits >= 1 << 6) {
            EXPECT_EQ(again & 0x7ff, bits);
            EXPECT_EQ(again >> 11 & 0x7ff, bits);
        }
        if (bits >> 1 >= 1 << 5) {
            EXPECT_EQ(again >> 22, bits >> 1);
        }
    }
}

TEST(SmallFloats, ShortFloatsHaveEnds) {
    EXPECT_EQ(from_short_floats(to_short_floats({-1, 1e9f, kInfinity})), (Rgb{0, 65024, kInfinity}));
    EXPECT_EQ(from_short_floats(to_short_floats({1, 0.5f, 64512})), (Rgb{1, 0.5f, 64512}));
    EXPECT_TRUE(std::isnan(from_short_floats(to_short_floats({NAN, 0, 0}))[0]));
}

TEST(SmallFloats, OneExponentForThree) {
    EXPECT_EQ(from_shared_exponent(to_shared_exponent({1, 0.5f, 0.25f})), (Rgb{1, 0.5f, 0.25f}));
    EXPECT_EQ(from_shared_exponent(to_shared_exponent({1e9f, -1, 0})), (Rgb{65408, 0, 0}));
    EXPECT_EQ(to_shared_exponent({0, 0, 0}), 0u);
    const Rgb mixed = from_shared_exponent(to_shared_exponent({1000, 0.3f, 1.4f}));
    EXPECT_EQ(mixed, (Rgb{1000, 0, 2})) << "steps of 2 beside a thousand";
    const Rgb carried = from_shared_exponent(to_shared_exponent({0.9999f, 0, 0}));
    EXPECT_EQ(carried[0], 1) << "a mantissa that rounds up needs the next exponent";
}

}  // namespace
}  // namespace wall::client
