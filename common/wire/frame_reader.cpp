// SPDX-License-Identifier: MIT
#include "common/wire/frame_reader.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace wall::wire {

std::span<std::byte> FrameReader::prepare() {
    direct_ = in_payload_ && read_ == filled_ && end_ - have_ >= kBuffer;
    if (direct_) {
        payload_.resize(std::min(end_, std::max(payload_.size(), have_ + kGrowth)));
        return std::span(payload_).subspan(have_);
    }
    std::memmove(buffer_.data(), buffer_.data() + read_, filled_ - read_);
    filled_ -= std::exchange(read_, 0);
    return std::span(buffer_).subspan(filled_);
}

void FrameReader::lend(RawBytes memory) {
    if (in_payload_ || in_parts_) return;
    RawBytes& next = header_.kind == FrameKind::coded ? decoded_ : payload_;
    if (next.capacity() < memory.capacity()) next = std::move(memory);
}

void FrameReader::forget_lent() {
    if (in_payload_ || in_parts_) return;
    payload_ = RawBytes();  // not {}, which keeps the memory
    decoded_ = RawBytes();
}

void FrameReader::begin_frame_again() {
    read_ = filled_ = 0;
    if (std::exchange(in_payload_, false)) have_ = start_;
}

void FrameReader::commit(std::size_t bytes) { (direct_ ? have_ : filled_) += bytes; }

Result<void> FrameReader::begin_frame() {
    header_ = decode_frame_header(buffer_.data() + read_);
    read_ += kFrameHeaderBytes;
    if (header_.payload_bytes > frame_limit_)
        return fail("frame of " + std::to_string(header_.payload_bytes) + " bytes, at most " +
                    std::to_string(frame_limit_) + " are allowed");
    if (!in_parts_) {
        have_ = 0;
        payload_.clear();
    } else if (header_.kind != FrameKind::part && header_.kind != FrameKind::batch) {
        return fail("another frame within the parts of a batch");
    }
    start_ = have_;
    end_ = have_ + header_.payload_bytes;
    if (end_ > batch_limit_)
        return fail("batch of " + std::to_string(end_) + " bytes or more, at most " + std::to_string(batch_limit_) +
                    " are allowed");
    in_payload_ = true;
    return {};
}

void FrameReader::take(std::size_t bytes) {
    payload_.resize(std::max(payload_.size(), have_ + bytes));
    if (bytes != 0) std::memcpy(payload_.data() + have_, buffer_.data() + read_, bytes);
    have_ += bytes;
    read_ += bytes;
}

/// The coded batch that has come.
Result<RawBytes> FrameReader::decode() {
    std::uint32_t bytes = 0;
    if (payload_.size() < sizeof bytes) return fail("coded batch of " + std::to_string(payload_.size()) + " bytes");
    std::memcpy(&bytes, payload_.data(), sizeof bytes);
    const auto most = std::min<std::size_t>(batch_limit_, kMostCodedBatch);
    if (bytes > most)
        return fail("coded batch of " + std::to_string(bytes) + " bytes, at most " + std::to_string(most) +
                    " are allowed");
    RawBytes out = std::exchange(decoded_, {});
    out.clear();
    if (auto done = decoder_.decode(std::span(payload_).subspan(sizeof bytes), bytes, out); !done)
        return tl::unexpected(done.error());
    return out;
}

Result<std::optional<Frame>> FrameReader::next() {
    if (failure_) return tl::unexpected(*failure_);
    auto frame = advance();
    if (!frame) failure_ = frame.error();
    return frame;
}

Result<std::optional<Frame>> FrameReader::advance() {
    for (;;) {
        if (!in_payload_) {
            if (filled_ - read_ < kFrameHeaderBytes) return std::optional<Frame>();
            if (auto begun = begin_frame(); !begun) return tl::unexpected(begun.error());
        }
        take(std::min(filled_ - read_, end_ - have_));
        if (have_ < end_) return std::optional<Frame>();
        in_payload_ = false;
        batch_frames_ += brings_commands(header_.kind);
        in_parts_ = header_.kind == FrameKind::part;
        if (in_parts_) continue;
        payload_.resize(end_);
        if (header_.kind == FrameKind::coded) {
            auto batch = decode();
            if (!batch) return tl::unexpected(batch.error());
            return std::optional<Frame>(Frame{FrameKind::batch, std::move(*batch)});
        }
        return std::optional<Frame>(Frame{header_.kind, std::exchange(payload_, {})});
    }
}

}  // namespace wall::wire
