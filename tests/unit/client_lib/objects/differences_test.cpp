// SPDX-License-Identifier: MIT
#include "client_lib/objects/differences.h"

#include <gtest/gtest.h>

#include <vector>

namespace wall::client {
namespace {

using Bytes = std::vector<std::byte>;

std::vector<ByteRange> differences(const Bytes& a, const Bytes& b) {
    std::vector<ByteRange> out;
    for_each_difference(a.data(), b.data(), a.size(), [&](ByteRange range) { out.push_back(range); });
    return out;
}

Bytes with(Bytes bytes, std::initializer_list<std::size_t> places) {
    for (const std::size_t place : places) bytes[place] ^= std::byte{1};
    return bytes;
}

TEST(Differences, OfTheSameThereAreNone) {
    for (const std::size_t size : {0u, 1u, 63u, 4096u, 10000u})
        EXPECT_TRUE(differences(Bytes(size), Bytes(size)).empty());
}

TEST(Differences, AreAsNarrowAsALine) {
    const Bytes a(10000);
    EXPECT_EQ(differences(a, with(a, {0})), (std::vector<ByteRange>{{0, 64}}));
    EXPECT_EQ(differences(a, with(a, {64, 200})), (std::vector<ByteRange>{{64, 256}}));
    EXPECT_EQ(differences(a, with(a, {9999})), (std::vector<ByteRange>{{9984, 10000}}));
    EXPECT_EQ(differences(a, with(a, {70, 5000, 9999})),
              (std::vector<ByteRange>{{64, 128}, {4992, 5056}, {9984, 10000}}));
}

TEST(Differences, OfPagesInARowAreOne) {
    const Bytes a(20000), b(20000, std::byte{1});
    EXPECT_EQ(differences(a, b), (std::vector<ByteRange>{{0, 20000}}));
    EXPECT_EQ(differences(a, with(a, {4095, 4096})), (std::vector<ByteRange>{{4032, 4160}}));
}

TEST(Differences, WhateverDiffersLiesInOne) {
    const Bytes a(9000);
    for (std::size_t place = 0; place < a.size(); place += 7) {
        const std::size_t other = (place * 31 + 5) % a.size();
        if (other == place) continue;
        const auto found = differences(a, with(a, {place, other}));
        for (const std::size_t byte : {place, other})
            EXPECT_TRUE(std::ranges::any_of(found, [&](const ByteRange& range) {
                return range.begin <= byte && byte < range.end;
            })) << byte;
    }
}

}  // namespace
}  // namespace wall::client
