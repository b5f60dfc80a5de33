// SPDX-License-Identifier: MIT
#include "common/recording/writer.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace wall::recording {

Result<Writer> Writer::create(const std::string& path, const Header& header) {
    constexpr mode_t kOwnersAndReaders = 0644;
    UniqueFd file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kOwnersAndReaders));
    if (!file) return fail(path + ": cannot be written: " + std::strerror(errno));
    Writer writer(std::move(file), path);
    if (auto done = writer.write(encode(header)); !done) return tl::unexpected(done.error());
    return writer;
}

Result<void> Writer::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(file_.get(), bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return fail(path_ + ": cannot be written: " + std::strerror(errno));
        bytes = bytes.subspan(static_cast<std::size_t>(n));
        bytes_ += static_cast<std::uint64_t>(n);
    }
    return {};
}

/// In one piece, so that a recorder that is killed leaves whole records.
Result<void> Writer::add(RecordKind kind, std::size_t plain_bytes, std::span<const std::byte> coded) {
    const RecordHead head{.kind = kind,
                          .plain_bytes = static_cast<std::uint32_t>(plain_bytes),
                          .coded_bytes = static_cast<std::uint32_t>(coded.size()),
                          .time = last_};
    const auto first = encode(head, coded);
    record_.assign(first.begin(), first.end());
    record_.insert(record_.end(), coded.begin(), coded.end());
    return write(record_);
}

Result<void> Writer::begin_segment(Time time, std::uint64_t frame) {
    if (segments_.size() == kMostSegments) return fail(path_ + ": a recording cannot have more segments");
    last_ = std::max(last_, time);
    encoder_ = wire::HistoryEncoder::create();
    if (!encoder_) return fail("no memory to code a recording");
    segments_.push_back({bytes_, last_, frame});
    return add(RecordKind::segment, sizeof frame, std::as_bytes(std::span(&frame, 1)));
}

Result<void> Writer::add_batch(std::span<const std::byte> payload, Time time) {
    last_ = std::max(last_, time);
    batch_bytes_ += payload.size();
    do {
        const auto piece = payload.first(std::min(payload.size(), kMostPlain));
        payload = payload.subspan(piece.size());
        coded_.clear();
        if (!encoder_ || !encoder_->encode(std::span(&piece, 1), coded_)) return fail("no memory to code a recording");
        const auto kind = payload.empty() ? RecordKind::batch : RecordKind::part;
        if (auto done = add(kind, piece.size(), coded_); !done) return done;
    } while (!payload.empty());
    return {};
}

Result<void> Writer::finish(Index index) {
    index.duration = last_;
    index.batch_bytes = batch_bytes_;
    index.segments = segments_;
    const std::uint64_t offset = bytes_;
    const auto content = encode(index);
    if (auto done = add(RecordKind::index, content.size(), content); !done) return done;
    if (auto done = write(encode_end(offset)); !done) return done;
    if (::fsync(file_.get()) != 0 && errno != EINVAL)  // a pipe
        return fail(path_ + ": cannot be written: " + std::strerror(errno));
    return {};
}

}  // namespace wall::recording
