// SPDX-License-Identifier: MIT
// Every SIMD build of the row kernels gives what the plain C++ one gives, and the inverses undo the residuals.
#include "common/codec/row_kernels.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

namespace wall::codec {
namespace {

constexpr std::size_t kMost = 71;  // pixels: several vectors and every remainder
using Row = std::vector<std::byte>;

struct Rows {
    Row row, above;
    RowStart start;
};

Rows random_rows(std::mt19937& random, bool small_steps) {
    Rows out{
        Row(4 * kMost), Row(4 * kMost), {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random())}};
    for (auto* row : {&out.row, &out.above})
        for (auto& byte : *row) byte = static_cast<std::byte>(small_steps ? 100 + random() % 3 : random());
    return out;
}

class RowKernelsTest : public testing::TestWithParam<const RowKernels*> {};

TEST_P(RowKernelsTest, ResidualsEqualThePlainOnes) {
    const RowKernels& plain = *all_row_kernels().front();
    const RowKernels& kernels = *GetParam();
    std::mt19937 random(5);
    for (std::size_t count = 0; count <= kMost; ++count) {
        for (const bool decorrelate : {false, true}) {
            const auto [row, above, start] = random_rows(random, count % 2 == 0);
            const auto both = [&, row = row.data(), above = above.data(), start = start](auto compute) {
                std::vector<std::uint32_t> expected(kMost), got(kMost);
                compute(plain, expected.data(), row, above, start);
                compute(kernels, got.data(), row, above, start);
                EXPECT_EQ(expected, got) << count << " pixels";
            };
            both([&](auto& k, auto* out, auto* r, auto*, auto s) { k.left(out, r, count, s, decorrelate); });
            both([&](auto& k, auto* out, auto* r, auto* a, auto s) { k.gradient(out, r, a, count, s, decorrelate); });
            both([&](auto& k, auto* out, auto* r, auto* a, auto s) { k.median(out, r, a, count, s, decorrelate); });
            both([&](auto& k, auto* out, auto* r, auto* a, auto) { k.difference(out, r, a, count, decorrelate); });
        }
    }
}

TEST_P(RowKernelsTest, InversesGiveTheRowBack) {
    const RowKernels& kernels = *GetParam();
    std::mt19937 random(6);
    for (std::size_t count = 0; count <= kMost; ++count) {
        const auto [row, above, start] = random_rows(random, count % 2 == 0);
        const Row expected(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(4 * count));
        std::vector<std::uint32_t> residuals(kMost);
        Row got(4 * count);
        kernels.left(residuals.data(), row.data(), count, start, false);
        kernels.add_left(got.data(), residuals.data(), count, start);
        EXPECT_EQ(got, expected) << "left";
        kernels.gradient(residuals.data(), row.data(), above.data(), count, start, false);
        kernels.add_gradient(got.data(), residuals.data(), above.data(), count, start);
        EXPECT_EQ(got, expected) << "gradient";
        kernels.median(residuals.data(), row.data(), above.data(), count, start, false);
        kernels.add_median(got.data(), residuals.data(), above.data(), count, start);
        EXPECT_EQ(got, expected) << "median";
        kernels.difference(residuals.data(), row.data(), above.data(), count, false);
        kernels.add_difference(got.data(), residuals.data(), above.data(), count);
        EXPECT_EQ(got, expected) << "difference";
    }
}

TEST_P(RowKernelsTest, CountsEqualThePlainOnes) {
    const RowKernels& plain = *all_row_kernels().front();
    const RowKernels& kernels = *GetParam();
    std::mt19937 random(7);
    for (std::size_t count = 0; count <= 64; ++count) {
        for (const std::uint32_t mask : {0xffffffffu, 0x00ffffffu}) {
            std::vector<std::uint32_t> residuals(64);
            for (auto& r : residuals) {
                const auto bits = static_cast<std::uint32_t>(random());
                r = random() % 3 == 0 ? bits : bits & 1u << 31;
            }
            EXPECT_EQ(kernels.nonzero(residuals.data(), count, mask), plain.nonzero(residuals.data(), count, mask));
            EXPECT_EQ(kernels.cost(residuals.data(), count, mask), plain.cost(residuals.data(), count, mask));
        }
    }
}

TEST_P(RowKernelsTest, AllEqualSeesEveryPixel) {
    const RowKernels& kernels = *GetParam();
    for (std::size_t count = 1; count <= kMost; ++count) {
        std::vector<std::uint32_t> pixels(count, 0x11223344);
        const auto equal = [&](std::uint32_t mask) {
            return kernels.all_equal(reinterpret_cast<const std::byte*>(pixels.data()), count, 0x11223344, mask);
        };
        EXPECT_TRUE(equal(~0u));
        for (std::size_t i = 0; i < count; ++i) {
            pixels[i] ^= 0x80000000;
            EXPECT_FALSE(equal(~0u));
            EXPECT_TRUE(equal(0x00ffffff));
            pixels[i] ^= 0x80000000;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Builds, RowKernelsTest, testing::ValuesIn(all_row_kernels().begin(), all_row_kernels().end()),
                         [](const auto& test) { return std::string(test.param->name); });

}  // namespace
}  // namespace wall::codec
