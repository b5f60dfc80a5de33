// SPDX-License-Identifier: MIT
// Where two contents of a buffer differ: a program may give a buffer what it has already, or nearly, and only what is
// modified should travel (T3.5). Pure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "client_lib/objects/changed_ranges.h"

namespace wall::client {

/// Calls tell(ByteRange) for ranges beyond which `size` bytes at `a` and `b` are the same, in order. Looks at pages;
/// what differs of one ends at lines of 64 bytes, and what is close lies in one range. Where all differs it reads
/// hardly anything.
template <class Tell>
void for_each_difference(const std::byte* a, const std::byte* b, std::size_t size, Tell&& tell) {
    constexpr std::size_t kPage = 4096, kLine = 64;
    const auto same = [&](std::size_t begin, std::size_t end) {
        return std::memcmp(a + begin, b + begin, end - begin) == 0;
    };
    ByteRange found;
    for (std::size_t page = 0; page < size; page += kPage) {
        ByteRange here{page, std::min(page + kPage, size)};
        if (same(here.begin, here.end)) continue;
        while (here.size() > kLine && same(here.begin, here.begin + kLine)) here.begin += kLine;
        while (here.size() > kLine && same((here.end - 1) / kLine * kLine, here.end))
            here.end = (here.end - 1) / kLine * kLine;
        if (found.size() != 0 && here.begin > found.end + ChangedRanges::kGap) {
            tell(found);
            found = here;
        } else {
            found = {found.size() != 0 ? found.begin : here.begin, here.end};
        }
    }
    if (found.size() != 0) tell(found);
}

}  // namespace wall::client
