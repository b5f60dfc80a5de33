// SPDX-License-Identifier: MIT
// Which bytes of something changed when: a follower that knows it as of some stamp is told what changed since, and no
// more (T3.5). The number of ranges is bounded: where there would be more, close ones grow together. Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace wall::client {

struct ByteRange {
    std::size_t begin = 0, end = 0;
    std::size_t size() const { return end - begin; }
    bool operator==(const ByteRange&) const = default;
};

class ChangedRanges {
public:
    static constexpr std::size_t kMost = 64;
    /// Two ranges with less between them travel as one: a command of its own would cost about as much.
    static constexpr std::size_t kGap = 64;
    /// An older range that is larger does not become newer by a neighbour: it would be sent again.
    static constexpr std::size_t kSmall = 4096;

    /// It is another, with nothing written in it.
    void reset(std::uint64_t stamp) {
        all_ = stamp;
        ranges_.clear();
        sealed_ = {};
    }
    /// What changed until now does not become newer by a neighbour: others have written beside it since.
    void seal() {
        for (const Range& range : ranges_)
            sealed_ = sealed_.bytes.size() == 0
                          ? range
                          : Range{join(sealed_.bytes, range.bytes), std::max(sealed_.stamp, range.stamp)};
        ranges_.clear();
    }
    void add(ByteRange range, std::uint64_t stamp) {
        if (range.size() == 0) return;
        for (Range& known : ranges_) {
            if (range.begin > known.bytes.end + kGap || known.bytes.begin > range.end + kGap) continue;
            const bool covered = range.begin <= known.bytes.begin && known.bytes.end <= range.end;
            if (!covered && known.bytes.size() > kSmall) continue;
            known = {join(known.bytes, range), stamp};
            return;
        }
        if (ranges_.size() == kMost) join_closest();
        ranges_.push_back({range, stamp});
    }

    /// Whether what a follower knows as of `known` (0: nothing) is not this one: then it lacks what changed since 0.
    bool lacks_all(std::uint64_t known) const { return known < all_; }
    /// Calls tell(ByteRange) for what changed since `known`; each byte at most once, in order.
    template <class Tell>
    void since(std::uint64_t known, Tell&& tell) const {
        std::vector<ByteRange> newer;
        for (const Range& range : ranges_)
            if (range.stamp > known) newer.push_back(range.bytes);
        if (sealed_.stamp > known) newer.push_back(sealed_.bytes);
        std::ranges::sort(newer, {}, &ByteRange::begin);
        for (std::size_t i = 0; i < newer.size();) {
            ByteRange whole = newer[i];
            while (++i < newer.size() && newer[i].begin <= whole.end) whole = join(whole, newer[i]);
            tell(whole);
        }
    }

private:
    struct Range {
        ByteRange bytes;
        std::uint64_t stamp = 0;
    };
    static ByteRange join(ByteRange a, ByteRange b) { return {std::min(a.begin, b.begin), std::max(a.end, b.end)}; }
    /// Two neighbours become one, as new as the newer: those by which the fewest bytes become newer than they are.
    void join_closest() {
        std::ranges::sort(ranges_, {}, [](const Range& r) { return r.bytes.begin; });
        const auto cost = [&](std::size_t i) {
            const Range &left = ranges_[i - 1], &right = ranges_[i];
            return join(left.bytes, right.bytes).size() - (left.stamp > right.stamp ? left : right).bytes.size();
        };
        std::size_t best = 1;
        for (std::size_t i = 2; i < ranges_.size(); ++i)
            if (cost(i) < cost(best)) best = i;
        Range& left = ranges_[best - 1];
        left = {join(left.bytes, ranges_[best].bytes), std::max(left.stamp, ranges_[best].stamp)};
        ranges_.erase(ranges_.begin() + static_cast<std::ptrdiff_t>(best));
    }

    std::uint64_t all_ = 0;
    std::vector<Range> ranges_;
    Range sealed_;  // all of what is older, which only those are told that know nothing of it
};

}  // namespace wall::client
