// SPDX-License-Identifier: MIT
#include "common/recording/reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "common/base/unique_fd.h"
#include "common/recording/stream_watch.h"
#include "common/wire/limits.h"

namespace wall::recording {
namespace {

/// The longest header there can be.
constexpr std::size_t kMostHeader = 64 + 2 * kMostText;

Result<std::size_t> read_file(int file, std::uint64_t offset, std::span<std::byte> to) {
    std::size_t done = 0;
    while (done < to.size()) {
        const ssize_t n = ::pread(file, to.data() + done, to.size() - done, static_cast<off_t>(offset + done));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return fail(std::string("cannot be read: ") + std::strerror(errno));
        if (n == 0) break;
        done += static_cast<std::size_t>(n);
    }
    return done;
}

}  // namespace

Result<Source> Source::open(const std::string& path) {
    const auto file = std::make_shared<UniqueFd>(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat info {};
    if (!*file || ::fstat(file->get(), &info) != 0) return fail(std::string("cannot be read: ") + std::strerror(errno));
    if (!S_ISREG(info.st_mode)) return fail("is no file");
    return Source{static_cast<std::uint64_t>(info.st_size),
                  [file](std::uint64_t offset, std::span<std::byte> to) { return read_file(file->get(), offset, to); }};
}

Source Source::of(std::span<const std::byte> bytes) {
    return {bytes.size(), [bytes](std::uint64_t offset, std::span<std::byte> to) -> Result<std::size_t> {
                const auto from = bytes.subspan(std::min<std::size_t>(offset, bytes.size()));
                const std::size_t count = std::min(from.size(), to.size());
                if (count != 0) std::memcpy(to.data(), from.data(), count);
                return count;
            }};
}

Result<Reader> Reader::open(Source source) {
    Reader reader(std::move(source));
    std::vector<std::byte> start(kMostHeader);
    const auto got = reader.source_.read(0, start);
    if (!got) return tl::unexpected(got.error());
    start.resize(*got);
    auto header = decode_header(start);
    if (!header) return tl::unexpected(header.error());
    reader.header_ = std::move(header->first);
    reader.first_ = header->second;
    reader.at_ = reader.first_;
    if (auto index = reader.read_index()) reader.index_ = std::move(*index);
    else reader.recover(index.error().message);
    if (reader.index_.segments.empty()) return fail("there is nothing in it yet: no segment has been recorded");
    reader.seek(0);
    return reader;
}

tl::unexpected<Error> Reader::wrong(std::uint64_t offset, const std::string& what) const {
    return fail("at byte " + std::to_string(offset) + " of " + std::to_string(source_.size) + ": " + what);
}

/// At the file's end, whole, and in accordance with where records are.
Result<Index> Reader::read_index() {
    std::array<std::byte, kEndBytes> end;
    if (source_.size < first_ + kEndBytes) return fail("it was not finished");
    const auto got = source_.read(source_.size - kEndBytes, end);
    if (!got) return tl::unexpected(got.error());
    const auto offset = *got == end.size() ? decode_end(end) : std::nullopt;
    if (!offset) return fail("it was not finished");
    if (*offset < first_ || *offset > source_.size - kEndBytes) return wrong(source_.size - kEndBytes, "no such index");
    at_ = *offset;
    end_ = source_.size - kEndBytes;
    const auto head = read_record();
    if (!head) return tl::unexpected(head.error());
    if (!*head || (*head)->kind != RecordKind::index) return wrong(*offset, "expected the index");
    auto index = decode_index(coded_);
    if (!index) return wrong(*offset, index.error().message);
    std::uint64_t before = 0;
    for (const Segment& segment : index->segments) {
        if (segment.offset < std::max(first_, before) || segment.offset >= *offset)
            return wrong(*offset, "an index of segments that cannot be there");
        before = segment.offset + 1;
    }
    end_ = *offset;
    return index;
}

/// As far as records are whole.
void Reader::recover(const std::string& why) {
    index_ = {};
    at_ = first_;
    end_ = source_.size;
    last_ = {};
    decoder_.reset();
    StreamWatch watch;
    std::uint64_t whole = first_;
    std::string stopped;
    for (;;) {
        const std::uint64_t here = at_;
        auto record = next();
        if (!record) stopped = record.error().message;
        if (!record || !*record) break;
        if ((*record)->kind == RecordKind::segment) {
            if (index_.segments.size() == kMostSegments) break;
            index_.segments.push_back({here, (*record)->time, watch.frames()});
        } else if (const auto seen = watch.look((*record)->payload); !seen) {
            stopped = wrong(here, seen.error().message).value().message;
            break;
        }
        index_.batch_bytes += (*record)->payload.size();
        index_.duration = (*record)->time;
        whole = at_;
    }
    index_.frames = watch.frames();
    index_.windows = watch.windows();
    end_ = whole;
    recovered_ = why + (stopped.empty() ? "" : "; " + stopped);
}

Reader Reader::another() const {
    Reader out(source_);
    out.header_ = header_;
    out.index_ = index_;
    out.recovered_ = recovered_;
    out.first_ = first_;
    out.end_ = end_;
    out.seek(0);
    return out;
}

void Reader::seek(std::size_t segment) {
    const Segment& to = index_.segments[segment];
    at_ = to.offset;
    last_ = to.time;
    decoder_.reset();
}

/// Its head; its bytes are in `coded_`. Nothing: at the end.
Result<std::optional<RecordHead>> Reader::read_record() {
    const std::uint64_t here = at_;
    if (here >= end_) return std::optional<RecordHead>();
    std::array<std::byte, kRecordHeadBytes> bytes;
    if (end_ - here < bytes.size()) return wrong(here, "a record is cut short");
    const auto got = source_.read(here, bytes);
    if (!got) return tl::unexpected(got.error());
    if (*got != bytes.size()) return wrong(here, "a record is cut short");
    const auto head = decode_record_head(bytes);
    if (!head) return wrong(here, head.error().message);
    if (end_ - here - bytes.size() < head->coded_bytes) return wrong(here, "a record is cut short");
    coded_.resize(head->coded_bytes);
    const auto rest = source_.read(here + bytes.size(), coded_);
    if (!rest) return tl::unexpected(rest.error());
    if (*rest != coded_.size()) return wrong(here, "a record is cut short");
    if (!is_whole(bytes, coded_)) return wrong(here, "a record is damaged (its checksum is another one)");
    at_ = here + bytes.size() + coded_.size();
    return std::optional(*head);
}

Result<std::optional<Record>> Reader::next() {
    Record record;
    for (bool within = false;;) {
        const std::uint64_t here = at_;
        const auto head = read_record();
        if (!head) return tl::unexpected(head.error());
        if (!*head || (*head)->kind == RecordKind::index) {
            if (within) return wrong(here, "a batch is cut short");
            return std::optional<Record>();
        }
        const auto& [kind, plain_bytes, coded_bytes, time, sum] = **head;
        if (time < last_) return wrong(here, "a record of an earlier time than the one before");
        last_ = record.time = time;
        if (kind == RecordKind::segment) {
            if (within) return wrong(here, "a segment begins within a batch");
            if (coded_.size() != sizeof(std::uint64_t)) return wrong(here, "no beginning of a segment");
            decoder_.emplace();
            record.kind = kind;
            return std::optional(std::move(record));
        }
        if (!decoder_) return wrong(here, "a batch before the first segment");
        if (record.payload.size() + plain_bytes > wire::kMaxBatchPayload) return wrong(here, "a batch is too large");
        if (auto done = decoder_->decode(coded_, plain_bytes, record.payload); !done)
            return wrong(here, done.error().message);
        within = kind == RecordKind::part;
        if (within) continue;
        record.kind = RecordKind::batch;
        return std::optional(std::move(record));
    }
}

}  // namespace wall::recording
