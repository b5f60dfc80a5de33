// SPDX-License-Identifier: MIT
#include "client_lib/objects/buffer.h"

#include <algorithm>
#include <cstring>

#include "client_lib/objects/differences.h"
#include "gen/glapi/wire.gen.h"

namespace wall::client {

namespace {

std::size_t differing_bytes(const std::byte* a, const std::byte* b, std::size_t size) {
    std::size_t out = 0;
    for_each_difference(a, b, size, [&](ByteRange range) { out += range.size(); });
    return out;
}

}  // namespace

bool Buffer::has_all_before() const { return stamp_ != 0 && !mapping_ && !drawn_; }

void Buffer::define(const void* data, std::size_t bytes, GLenum usage) {
    const auto* first = static_cast<const std::byte*>(data);
    // Where most is new, other memory is better: a driver need not wait for who still reads the one before.
    if (first && bytes == size() && usage == usage_ && has_all_before() &&
        differing_bytes(memory_->bytes.data(), first, bytes) <= bytes / 2)
        return write({0, bytes}, data);
    if (memory_->readings.load(std::memory_order_acquire) != 0) memory_ = std::make_shared<BufferMemory>();
    if (data) memory_->bytes.assign(first, first + bytes);
    else memory_->bytes.assign(bytes, std::byte{0});
    if (stamp_ == 0 || usage != usage_) churn.expect(usage);
    usage_ = usage;
    mapping_.reset();
    drawn_ = false;
    zeros_ = data == nullptr;
    stamp_ = next_stamp();
    count_change();
    changes_.reset(stamp_);
    if (!data) return;  // what is going to be written counts then, and nothing else of it travels
    changes_.add({0, bytes}, stamp_);
    churn.changed(bytes);
}

void Buffer::define_storage(const void* data, std::size_t bytes, GLbitfield flags) {
    define(data, bytes, GL_DYNAMIC_DRAW);  // as Mesa answers when it is asked for the usage
    storage_flags_ = flags;
    immutable_ = true;
}

void Buffer::write(ByteRange range, const void* data) {
    const auto* source = static_cast<const std::byte*>(data);
    const auto copy = [&](ByteRange part) {  // of `range`, of what is given
        std::memcpy(begin_writing() + range.begin + part.begin, source + part.begin, part.size());
        wrote({range.begin + part.begin, range.begin + part.end});
    };
    if (!has_all_before()) return copy({0, range.size()});
    // From its start on each time: for those who read, begin_writing() may make other memory.
    const std::shared_ptr<BufferMemory> before = memory_;
    for_each_difference(before->bytes.data() + range.begin, source, range.size(), copy);
}

std::byte* Buffer::begin_writing() {
    leave_to_readers();
    return memory_->bytes.data();
}

void Buffer::wrote(ByteRange range) {
    stamp_ = next_stamp();
    count_change();
    zeros_ = false;
    changes_.add(range, stamp_);
    churn.changed(range.size());
}

void Buffer::note_drawn() {
    stamp_ = next_stamp();
    count_change();
    drawn_ = true;
    zeros_ = false;
    changes_.seal();
}

/// The nodes that are told of later changes have it.
void Buffer::take_drawn(std::span<const std::byte> content) {
    leave_to_readers();
    std::ranges::copy(content, memory_->bytes.begin());
    drawn_ = false;
    count_change();
    changes_.add({0, content.size()}, stamp_);
}

void Buffer::pack_drawn(const AskHolder& ask, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    for (std::size_t at = 0; at < size(); at += kLargestBufferCommand) {
        const std::size_t bytes = std::min(kLargestBufferCommand, size() - at);
        const auto answer = ask(
            [&](wire::PackBuffer& question, RequestId request) {
                glapi::pack::BufferRead(question, request, id, static_cast<std::uint32_t>(at),
                                        static_cast<std::uint32_t>(bytes));
            },
            {});
        if (!answer || answer->size() != bytes) return;
        glapi::pack::BufferSubData(buffer, id, static_cast<std::uint32_t>(at), *answer);
        packed();
    }
}

/// Who reads goes on with the bytes as they are now. What the program has a pointer to stays where it is.
void Buffer::leave_to_readers() {
    if (mapping_ || memory_->readings.load(std::memory_order_acquire) == 0) return;
    auto copy = std::make_shared<BufferMemory>();
    copy->bytes = memory_->bytes;
    memory_ = std::move(copy);
}

std::byte* Buffer::map(const BufferMapping& mapping) {
    std::byte* const bytes = mapping.writes() ? begin_writing() : memory_->bytes.data();
    if (mapping.writes() && !mapping.tells()) pages_.begin(memory_->bytes, mapping.range, zeros_);
    mapping_ = mapping;
    count_change();
    access = mapping.access;
    return bytes + mapping.range.begin;
}

void Buffer::unmap() {
    if (mapping_->writes() && !mapping_->tells()) find_written(mapping_->range);
    mapping_.reset();
    count_change();
    pages_ = {};
}

bool Buffer::find_written(ByteRange range) {
    bool any = false;
    // Whole pages: one that was looked at is known from then on, with what changed beside the range.
    constexpr std::size_t kPage = ChangedPages::kPageBytes;
    const ByteRange pages{range.begin / kPage * kPage, (range.end + kPage - 1) / kPage * kPage};
    pages_.find(memory_->bytes, pages, [&](ByteRange changed) {
        wrote(changed);
        any = true;
    });
    return any;
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
