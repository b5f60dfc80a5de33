// SPDX-License-Identifier: MIT
// A recording that somebody else has made, or that a disk has damaged: it is read to its end from each of its segments,
// or an error says where not. Checksums are put right first, since nobody would hit upon them; as it came it is read as
// well.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "common/base/assert.h"
#include "common/recording/reader.h"
#include "common/recording/stream_watch.h"

namespace {

using namespace wall::recording;

constexpr std::size_t kMostRead = 64 << 20;  // bytes that come out of one input

void read_all(std::span<const std::byte> bytes) {
    auto reader = Reader::open(Source::of(bytes));
    WALL_ASSERT(reader || !reader.error().message.empty());
    if (!reader) return;
    std::size_t read = 0;
    for (std::size_t segment = 0; segment < reader->index().segments.size() && read < kMostRead; ++segment) {
        reader->seek(segment);
        StreamWatch watch;
        Time last{};
        while (read < kMostRead) {
            const auto record = reader->next();
            if (!record || !*record) break;
            WALL_ASSERT((*record)->time >= last);
            last = (*record)->time;
            read += (*record)->payload.size();
            if ((*record)->kind == RecordKind::batch) static_cast<void>(watch.look((*record)->payload));
        }
    }
}

/// Of the header, and of each record that is found behind it.
void put_right(std::vector<std::byte>& bytes) {
    constexpr std::size_t kSumBytes = sizeof(std::uint32_t), kTextsAt = 24, kCodedAt = 12;
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        if (at + kSumBytes <= bytes.size()) std::memcpy(&value, bytes.data() + at, kSumBytes);
        return std::size_t{value};
    };
    const auto set = [&](std::size_t at, std::uint32_t sum) {
        if (at + kSumBytes <= bytes.size()) std::memcpy(bytes.data() + at, &sum, kSumBytes);
    };
    std::size_t at = kTextsAt;
    for (int text = 0; text < 2 && at < bytes.size(); ++text) at += kSumBytes + std::min(word(at), bytes.size());
    if (at + kSumBytes > bytes.size()) return;
    set(at, checksum(std::span(bytes).first(at)));
    at += kSumBytes;
    while (at + kRecordHeadBytes <= bytes.size()) {
        const std::size_t coded = word(at + kCodedAt);
        if (coded > bytes.size() - at - kRecordHeadBytes) return;
        const std::span record = std::span(bytes).subspan(at, kRecordHeadBytes + coded);
        set(at + kRecordHeadBytes - kSumBytes,
            checksum(record.subspan(kRecordHeadBytes), checksum(record.first(kRecordHeadBytes - kSumBytes))));
        at += record.size();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto given = std::as_bytes(std::span(data, size));
    std::vector<std::byte> bytes(given.begin(), given.end());
    read_all(bytes);
    put_right(bytes);
    read_all(bytes);
    return 0;
}
