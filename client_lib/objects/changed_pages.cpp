// SPDX-License-Identifier: MIT
#include "client_lib/objects/changed_pages.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

namespace wall::client {
namespace {

constexpr std::size_t kLanes = 8;  // whose multiplications overlap
constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15;

/// For each word another hash, and for each hash another one: no single word can change unseen.
constexpr std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) { return std::rotl((hash ^ word) * kFactor, 29); }

std::span<const std::byte> page_at(std::span<const std::byte> content, std::size_t page) {
    const std::size_t begin = page * ChangedPages::kPageBytes;
    return content.subspan(begin, std::min(ChangedPages::kPageBytes, content.size() - begin));
}

}  // namespace

std::uint64_t page_hash(std::span<const std::byte> page) {
    std::array<std::uint64_t, kLanes> lanes, words;
    for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = i + 1;
    std::size_t at = 0;
    for (; at + sizeof words <= page.size(); at += sizeof words) {
        std::memcpy(words.data(), page.data() + at, sizeof words);
        for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = mixed(lanes[i], words[i]);
    }
    if (at < page.size()) {
        words = {};
        std::memcpy(words.data(), page.data() + at, page.size() - at);
        for (std::size_t i = 0; i < kLanes; ++i) lanes[i] = mixed(lanes[i], words[i]);
    }
    std::uint64_t hash = page.size();
    for (const std::uint64_t lane : lanes) hash = mixed(hash, lane);
    return hash ^ hash >> 32;
}

void ChangedPages::begin(std::span<const std::byte> content, ByteRange range, bool zeros) {
    watched_ = range;
    hashes_.clear();
    if (range.size() == 0) return;
    const std::size_t last = page_of(range.end - 1);
    static constexpr std::array<std::byte, kPageBytes> kZeros{};
    const std::uint64_t of_zeros = zeros ? page_hash(kZeros) : 0;
    for (std::size_t page = page_of(range.begin); page <= last; ++page) {
        const auto bytes = page_at(content, page);
        hashes_.push_back(zeros && bytes.size() == kPageBytes ? of_zeros : page_hash(bytes));
    }
}

bool ChangedPages::has_changed(std::span<const std::byte> content, std::size_t page) {
    std::uint64_t& known = hashes_[page - page_of(watched_.begin)];
    const std::uint64_t now = page_hash(page_at(content, page));
    return std::exchange(known, now) != now;
}

}  // namespace wall::client
