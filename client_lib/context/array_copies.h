// SPDX-License-Identifier: MIT
// Copies of arrays in the program's memory, for the nodes: what does not change is sent once, and of what changes only
// the modified ranges travel (T3.5), like of a buffer. A program may write into its arrays whenever it likes, so what a
// draw takes is compared with the copy first, unless glLockArraysEXT promises that it stays. Only memory that the draw
// takes, or that lies on a page with some that it takes, is looked at. The context's thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include "client_lib/context/buffer_use.h"
#include "client_lib/objects/share_group.h"

namespace wall::client {

/// Arrays that lie within each other, element by element: one piece of memory.
struct ArrayBlock {
    std::uintptr_t start = 0;
    std::size_t stride = 0;
    std::size_t width = 0;  ///< bytes from the first that an element has to its last
    bool operator==(const ArrayBlock&) const = default;
};

/// The copy of one.
struct ArrayCopy {
    std::shared_ptr<Buffer> buffer;  ///< from element 0 on; null: it was seen only
    std::uint64_t last_use = 0;
    unsigned wait = 0;       ///< draws that it is not looked at, because it was another one each time
    unsigned patience = 1;   ///< how many the next time
    std::uint64_t lock = 0;  ///< the lock under which `locked` was looked at
    ByteRange locked;        ///< is as the program's since then
};

class ArrayCopies {
public:
    // ---- glLockArraysEXT ----
    void lock() { lock_ = ++locks_; }
    void unlock() { lock_ = 0; }

    /// The copy of the block; may have no buffer. It stays until the next take.
    ArrayCopy& copy_of(const ArrayBlock& block);
    std::uint64_t next_use() { return ++uses_; }
    /// Who holds the copies' buffers, and what is done before one changes; no mutex is held then.
    struct Holder {
        ShareGroup& share;
        BufferUse& buffers;
        std::function<void(const Buffer&)> before_writing;
    };
    /// Brings these bytes of the copy up to date with the program's.
    void refresh(const Holder& holder, const ArrayBlock& block, ArrayCopy& copy, ByteRange range);
    /// Takes out, when there are too many or they are too large, those that were not used for longest.
    std::vector<std::shared_ptr<Buffer>> take_unused();
    std::vector<std::shared_ptr<Buffer>> take_all();

    static constexpr std::size_t kMost = 1024;
    static constexpr std::size_t kMostBytes = std::size_t{256} << 20;

private:
    struct Hash {
        std::size_t operator()(const ArrayBlock& block) const {
            return (block.start * 31 + block.stride) * std::size_t{0x9e3779b97f4a7c15} ^ block.width;
        }
    };
    bool make_room(const Holder& holder, ArrayCopy& copy, std::size_t bytes);

    std::unordered_map<ArrayBlock, ArrayCopy, Hash> copies_;
    std::size_t bytes_ = 0;
    std::uint64_t uses_ = 0, locks_ = 0, lock_ = 0;
};

}  // namespace wall::client
