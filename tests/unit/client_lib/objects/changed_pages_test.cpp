// SPDX-License-Identifier: MIT
// Which pages of mapped memory have changed.
#include "client_lib/objects/changed_pages.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace wall::client {
namespace {

constexpr std::size_t kPage = ChangedPages::kPageBytes;
using Bytes = std::vector<std::byte>;

std::vector<ByteRange> found(ChangedPages& pages, const Bytes& content, ByteRange range) {
    std::vector<ByteRange> out;
    pages.find(content, range, [&](ByteRange changed) { out.push_back(changed); });
    return out;
}

TEST(ChangedPages, OnesThatChangedAreToldOnce) {
    Bytes content(10 * kPage, std::byte{3});
    ChangedPages pages;
    const ByteRange all{0, content.size()};
    pages.begin(content, all, false);
    EXPECT_TRUE(found(pages, content, all).empty());
    content[2 * kPage] = content[3 * kPage + 17] = content[7 * kPage - 1] = std::byte{4};
    EXPECT_EQ(found(pages, content, all), (std::vector<ByteRange>{{2 * kPage, 4 * kPage}, {6 * kPage, 7 * kPage}}));
    EXPECT_TRUE(found(pages, content, all).empty());
    content[2 * kPage] = std::byte{3};
    EXPECT_EQ(found(pages, content, all).size(), 1u) << "as it was, but not as it was last";
}

TEST(ChangedPages, OnlyTheRangeIsLookedAt) {
    Bytes content(10 * kPage + 100);
    ChangedPages pages;
    const ByteRange mapped{kPage + 10, content.size() - 3};
    pages.begin(content, mapped, true);
    for (std::size_t page = 0; page <= 10; ++page) content[page * kPage + 50] = std::byte{1};
    EXPECT_EQ(found(pages, content, {3 * kPage, 3 * kPage + 1}), (std::vector<ByteRange>{{3 * kPage, 3 * kPage + 1}}));
    EXPECT_EQ(found(pages, content, {0, 2 * kPage}), (std::vector<ByteRange>{{kPage + 10, 2 * kPage}}))
        << "not what is not mapped";
    EXPECT_EQ(found(pages, content, {0, content.size()}),
              (std::vector<ByteRange>{{2 * kPage, 3 * kPage}, {4 * kPage, content.size() - 3}}));
    EXPECT_TRUE(found(pages, content, {0, 10}).empty());
    EXPECT_TRUE(found(pages, content, {content.size() - 2, content.size()}).empty());
}

TEST(ChangedPages, NothingIsMapped) {
    ChangedPages pages;
    const Bytes content(100);
    EXPECT_TRUE(found(pages, content, {0, 100}).empty());
    pages.begin(content, {50, 50}, false);
    EXPECT_TRUE(found(pages, content, {0, 100}).empty());
}

TEST(PageHash, EveryBitAndTheLengthCount) {
    std::mt19937 random(3);
    Bytes page(kPage);
    for (std::byte& b : page) b = static_cast<std::byte>(random());
    std::set<std::uint64_t> seen{page_hash(page)};
    for (std::size_t bit = 0; bit < kPage * 8; bit += 7) {
        page[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
        EXPECT_TRUE(seen.insert(page_hash(page)).second) << bit;
        page[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
    }
    const Bytes zeros(kPage);
    for (const std::size_t length : {1u, 2u, 8u, 63u, 64u, 65u, 4095u, 4096u})
        EXPECT_TRUE(seen.insert(page_hash(std::span(zeros).first(length))).second) << length;
    Bytes swapped = page;  // words that change places
    std::swap_ranges(swapped.begin(), swapped.begin() + 64, swapped.begin() + 64);
    EXPECT_TRUE(seen.insert(page_hash(swapped)).second);
    std::swap_ranges(page.begin(), page.begin() + 8, page.begin() + 8);
    EXPECT_TRUE(seen.insert(page_hash(page)).second);
}

}  // namespace
}  // namespace wall::client
