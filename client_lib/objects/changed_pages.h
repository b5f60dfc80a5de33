// SPDX-License-Identifier: MIT
// Which pages of memory that a program has mapped have changed, found by looking: a hash of each page (4 KiB) is kept
// and compared. A copy to compare with would double the memory of every buffer. What an operating system could tell is
// not for a library in a foreign process: soft-dirty bits are of the whole process, and others may clear them; write
// protection takes SIGSEGV, which belongs to the program, and system calls that write into the memory fail (read():
// EFAULT). Pure; one thread at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "client_lib/objects/changed_ranges.h"

namespace wall::client {

class ChangedPages {
public:
    static constexpr std::size_t kPageBytes = 4096;

    /// Looks at the pages of `content` that `range` touches, as they are now. `zeros`: all of them are known to be 0.
    void begin(std::span<const std::byte> content, ByteRange range, bool zeros);
    /// Calls tell(ByteRange) for what lies in `range` on pages that changed since they were looked at last; pages in a
    /// row together. What lies outside of begin()'s range is not looked at.
    template <class Tell>
    void find(std::span<const std::byte> content, ByteRange range, Tell&& tell) {
        range = {std::max(range.begin, watched_.begin), std::min(range.end, watched_.end)};
        if (range.begin >= range.end) return;
        ByteRange changed;
        for (std::size_t page = page_of(range.begin); page * kPageBytes < range.end; ++page) {
            if (!has_changed(content, page)) continue;
            const ByteRange here{std::max(page * kPageBytes, range.begin),
                                 std::min((page + 1) * kPageBytes, range.end)};
            if (changed.size() != 0 && changed.end == here.begin) {
                changed.end = here.end;
                continue;
            }
            if (changed.size() != 0) tell(changed);
            changed = here;
        }
        if (changed.size() != 0) tell(changed);
    }

private:
    static std::size_t page_of(std::size_t byte) { return byte / kPageBytes; }
    bool has_changed(std::span<const std::byte> content, std::size_t page);

    ByteRange watched_;
    std::vector<std::uint64_t> hashes_;  ///< from that of the first page in `watched_` on
};

/// Not for keeping secrets: two contents that somebody chose may have the same. A change of up to eight bytes at a
/// multiple of eight always makes another one.
std::uint64_t page_hash(std::span<const std::byte> page);

}  // namespace wall::client
