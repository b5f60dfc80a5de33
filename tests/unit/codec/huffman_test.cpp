// SPDX-License-Identifier: MIT
#include "common/codec/huffman.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace wall::codec {
namespace {

double kraft(const std::vector<std::uint8_t>& lengths) {
    return std::accumulate(lengths.begin(), lengths.end(), 0.0,
                           [](double sum, auto length) { return length ? sum + std::ldexp(1.0, -length) : sum; });
}

TEST(HuffmanLengths, AreThoseOfHuffmansTree) {
    const std::vector<std::uint32_t> counts{45, 13, 12, 16, 9, 5};  // Cormen et al., section 16.3
    EXPECT_EQ(huffman_lengths(counts, 15), (std::vector<std::uint8_t>{1, 3, 3, 3, 4, 4}));
}

TEST(HuffmanLengths, KeepTheLimitAndStayComplete) {
    std::mt19937 random(3);
    for (const unsigned limit : {8u, 9u, 11u, 15u}) {
        std::vector<std::uint32_t> counts(256);
        for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = 1 + (i < 30 ? 1u << i : random() % 3);
        const auto lengths = huffman_lengths(counts, limit);
        EXPECT_EQ(kraft(lengths), 1.0) << limit;
        for (const auto length : lengths) EXPECT_LE(length, limit);
        EXPECT_LE(lengths[29], lengths[0]);
    }
}

TEST(HuffmanLengths, FewSymbols) {
    EXPECT_EQ(huffman_lengths(std::vector<std::uint32_t>{0, 0}, 8), (std::vector<std::uint8_t>{0, 0}));
    EXPECT_EQ(huffman_lengths(std::vector<std::uint32_t>{0, 7}, 8), (std::vector<std::uint8_t>{0, 1}));
    EXPECT_EQ(huffman_lengths(std::vector<std::uint32_t>{1, 0, 1000}, 8), (std::vector<std::uint8_t>{1, 0, 1}));
}

TEST(CanonicalCodes, LongestFirstFromZero) {
    const auto codes = canonical_codes(std::vector<std::uint8_t>{1, 3, 3, 2}).value();
    EXPECT_EQ(codes[1].bits, 0u);
    EXPECT_EQ(codes[2].bits, 1u);
    EXPECT_EQ(codes[3].bits, 1u);
    EXPECT_EQ(codes[0].bits, 1u);
}

TEST(CanonicalCodes, RefuseWhatIsNoPrefixCode) {
    EXPECT_FALSE(canonical_codes(std::vector<std::uint8_t>{1, 1, 1}));
    EXPECT_FALSE(canonical_codes(std::vector<std::uint8_t>{1, 3}));
    EXPECT_FALSE(canonical_codes(std::vector<std::uint8_t>{1, 1, 40}));
    EXPECT_FALSE(canonical_codes(std::vector<std::uint8_t>(256, 7)));
}

}  // namespace
}  // namespace wall::codec
