// SPDX-License-Identifier: MIT
#include "client_lib/context/array_copies.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace wall::client {
namespace {

constexpr std::size_t kPage = ChangedPages::kPageBytes;

}  // namespace

ArrayCopy& ArrayCopies::copy_of(const ArrayBlock& block) { return copies_[block]; }

bool ArrayCopies::make_room(const Holder& holder, ArrayCopy& copy, std::size_t bytes) {
    if (!copy.buffer) {
        copy.buffer = std::make_shared<Buffer>(next_object_id(), 0);
        holder.buffers.by_id[copy.buffer->id] = copy.buffer;
        std::lock_guard lock(holder.share.mutex);
        holder.share.by_id[copy.buffer->id] = copy.buffer;
    }
    if (copy.buffer->size() >= bytes) return false;
    const std::size_t more = std::max(bytes, copy.buffer->size() * 3 / 2);
    bytes_ += more - copy.buffer->size();
    holder.before_writing(*copy.buffer);
    std::lock_guard lock(holder.share.mutex);
    copy.buffer->define(nullptr, more, GL_DYNAMIC_DRAW);
    return true;
}

void ArrayCopies::refresh(const Holder& holder, const ArrayBlock& block, ArrayCopy& copy, ByteRange range) {
    if (make_room(holder, copy, range.end)) copy.lock = 0;
    const bool locked = lock_ != 0 && copy.lock == lock_;
    if (locked && copy.locked.begin <= range.begin && range.end <= copy.locked.end) return;
    const auto* memory = reinterpret_cast<const std::byte*>(block.start);
    bool told = false;
    for (std::size_t at = range.begin; at < range.end;) {
        const std::size_t end = std::min((at / kPage + 1) * kPage, range.end);
        if (std::memcmp(memory + at, copy.buffer->data() + at, end - at) != 0) {
            if (!std::exchange(told, true)) holder.before_writing(*copy.buffer);
            std::lock_guard lock(holder.share.mutex);
            copy.buffer->write({at, end}, memory + at);
        }
        at = end;
    }
    if (lock_ != 0) copy.lock = lock_, copy.locked = range;
}

std::vector<std::shared_ptr<Buffer>> ArrayCopies::take_unused() {
    if (copies_.size() <= kMost && bytes_ <= kMostBytes) return {};
    std::vector<std::uint64_t> uses;
    for (const auto& [block, copy] : copies_) uses.push_back(copy.last_use);
    const auto middle = uses.begin() + static_cast<std::ptrdiff_t>(uses.size() / 2);
    std::ranges::nth_element(uses, middle);
    std::vector<std::shared_ptr<Buffer>> out;
    for (auto at = copies_.begin(); at != copies_.end();) {
        ArrayCopy& copy = at->second;
        if (copy.last_use > *middle) {
            ++at;
            continue;
        }
        if (copy.buffer) {
            bytes_ -= copy.buffer->size();
            copy.buffer->deleted = true;
            out.push_back(std::move(copy.buffer));
        }
        at = copies_.erase(at);
    }
    return out;
}

std::vector<std::shared_ptr<Buffer>> ArrayCopies::take_all() {
    std::vector<std::shared_ptr<Buffer>> out;
    for (auto& [block, copy] : copies_)
        if (copy.buffer) out.push_back(std::move(copy.buffer));
    copies_.clear();
    bytes_ = 0;
    return out;
}

}  // namespace wall::client
