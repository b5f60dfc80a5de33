// SPDX-License-Identifier: MIT
#include "common/codec/huffman.h"

#include <algorithm>
#include <string>
#include <utility>

#include "common/base/assert.h"

namespace wall::codec {
namespace {

constexpr unsigned kMaxLength = 31;

struct Leaf {
    std::uint32_t count;
    std::uint32_t symbol;
};

std::vector<Leaf> leaves_of(std::span<const std::uint32_t> counts) {
    std::vector<Leaf> leaves;
    for (std::uint32_t symbol = 0; symbol < counts.size(); ++symbol)
        if (counts[symbol] != 0) leaves.push_back({counts[symbol], symbol});
    std::stable_sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.count < b.count; });
    return leaves;
}

/// How many leaves lie at each depth of the Huffman tree: two queues, leaves and inner nodes, both in rising order.
std::vector<std::uint32_t> leaves_per_depth(const std::vector<Leaf>& leaves) {
    const std::size_t n = leaves.size();
    std::vector<std::uint64_t> weight(2 * n - 1);
    std::vector<std::uint32_t> parent(2 * n - 1, 0);
    for (std::size_t i = 0; i < n; ++i) weight[i] = leaves[i].count;
    std::size_t leaf = 0, inner = n;
    for (std::size_t made = n; made < 2 * n - 1; ++made) {
        for (int side = 0; side < 2; ++side) {
            const bool take_leaf = leaf < n && (inner >= made || weight[leaf] <= weight[inner]);
            const std::size_t taken = take_leaf ? leaf++ : inner++;
            weight[made] += weight[taken];
            parent[taken] = static_cast<std::uint32_t>(made);
        }
    }
    std::vector<std::uint32_t> depth(2 * n - 1, 0), per_depth(n + 1, 0);
    for (std::size_t i = 2 * n - 2; i-- > 0;) {
        depth[i] = depth[parent[i]] + 1;
        if (i < n) ++per_depth[depth[i]];
    }
    return per_depth;
}

/// Moves leaves that are too deep up to `limit`, and pushes shallower ones down until the code is complete again.
void limit_depth(std::vector<std::uint32_t>& per_depth, unsigned limit) {
    if (per_depth.size() <= limit + 1) return;
    for (std::size_t deep = limit + 1; deep < per_depth.size(); ++deep)
        per_depth[limit] += std::exchange(per_depth[deep], 0);
    std::uint64_t used = 0;  // of 2^limit
    for (unsigned depth = 1; depth <= limit; ++depth) used += std::uint64_t{per_depth[depth]} << (limit - depth);
    for (; used > std::uint64_t{1} << limit; --used) {
        unsigned depth = limit - 1;
        while (per_depth[depth] == 0) --depth;
        --per_depth[limit];
        --per_depth[depth];
        per_depth[depth + 1] += 2;
    }
}

}  // namespace

std::vector<std::uint8_t> huffman_lengths(std::span<const std::uint32_t> counts, unsigned limit) {
    std::vector<std::uint8_t> lengths(counts.size(), 0);
    const auto leaves = leaves_of(counts);
    WALL_ASSERT(limit <= kMaxLength && leaves.size() <= std::size_t{1} << limit);
    if (leaves.size() == 1) lengths[leaves[0].symbol] = 1;
    if (leaves.size() < 2) return lengths;
    auto per_depth = leaves_per_depth(leaves);
    limit_depth(per_depth, limit);
    std::size_t next = leaves.size();  // from the most frequent down, from the shortest code up
    for (unsigned depth = 1; depth < per_depth.size() && depth <= limit; ++depth)
        for (std::uint32_t i = 0; i < per_depth[depth]; ++i)
            lengths[leaves[--next].symbol] = static_cast<std::uint8_t>(depth);
    return lengths;
}

Result<std::vector<Code>> canonical_codes(std::span<const std::uint8_t> lengths) {
    std::vector<Code> codes(lengths.size());
    std::uint64_t next = 0;
    for (unsigned length = kMaxLength; length > 0; --length) {
        for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol)
            if (lengths[symbol] == length)
                codes[symbol] = {static_cast<std::uint32_t>(next++), static_cast<std::uint8_t>(length)};
        if (next > std::uint64_t{1} << length)
            return fail("code lengths are over-full at " + std::to_string(length) + " bits");
        if (next % 2 != 0 && !(next == 1 && length == 1))
            return fail("code lengths leave half a pair at " + std::to_string(length) + " bits");
        next /= 2;
    }
    if (std::any_of(lengths.begin(), lengths.end(), [](auto length) { return length > kMaxLength; }))
        return fail("a code length is over " + std::to_string(kMaxLength) + " bits");
    return codes;
}

}  // namespace wall::codec
