// SPDX-License-Identifier: MIT
#include "client_lib/objects/buffer.h"

#include <cstring>

#include "gen/glapi/wire.gen.h"

namespace wall::client {

void Buffer::define(const void* data, std::size_t bytes, GLenum usage) {
    if (memory_->readings.load(std::memory_order_acquire) != 0) memory_ = std::make_shared<BufferMemory>();
    const auto* first = static_cast<const std::byte*>(data);
    if (data) memory_->bytes.assign(first, first + bytes);
    else memory_->bytes.resize(bytes);
    if (stamp_ == 0 || usage != usage_) churn.expect(usage);
    usage_ = usage;
    mapped = false;
    stamp_ = next_stamp();
    changes_.reset(stamp_);
    if (!data) return;  // what is going to be written counts then, and nothing else of it travels
    changes_.add({0, bytes}, stamp_);
    churn.changed(bytes);
}

void Buffer::write(ByteRange range, const void* data) {
    std::memcpy(begin_writing() + range.begin, data, range.size());
    wrote(range);
}

std::byte* Buffer::begin_writing() {
    leave_to_readers();
    return memory_->bytes.data();
}

void Buffer::wrote(ByteRange range) {
    stamp_ = next_stamp();
    changes_.add(range, stamp_);
    churn.changed(range.size());
}

/// Who reads goes on with the bytes as they are now.
void Buffer::leave_to_readers() {
    if (memory_->readings.load(std::memory_order_acquire) == 0) return;
    auto copy = std::make_shared<BufferMemory>();
    copy->bytes = memory_->bytes;
    memory_ = std::move(copy);
}

void Buffer::pack_changes(std::uint64_t known, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    const std::span<const std::byte> content = memory_->bytes;
    const auto pack_range = [&](ByteRange range) {
        for (std::size_t at = range.begin; at < range.end; at += kLargestBufferCommand) {
            const std::size_t bytes = std::min(kLargestBufferCommand, range.end - at);
            glapi::pack::BufferSubData(buffer, id, static_cast<std::uint32_t>(at), content.subspan(at, bytes));
            packed();
        }
    };
    if (changes_.lacks_all(known)) {
        glapi::pack::BufferData(buffer, id, static_cast<std::uint32_t>(content.size()), usage_);
        known = 0;
    }
    changes_.since(known, pack_range);
}

}  // namespace wall::client
