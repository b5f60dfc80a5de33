// SPDX-License-Identifier: MIT
// A program's commands in a file: what a node of its own would have got, one that sees all of each window at 1:1. A
// file is a follower, too (T7.1): it begins with the difference from nothing, and so does each of its segments, from
// which on it can be read. docs/recordings.md has the grammar. Everything is little endian; times count from the
// recording's beginning, and do not go back. A file without its end, of a recorder that was killed, is read as far as
// its records are whole. Pure; any thread.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/wire/history_coder.h"

namespace wall::recording {

inline constexpr std::string_view kMagic = "\x89WGLREC\n", kRecordMark = "WREC", kEndMark = "WRECEND\n";
inline constexpr std::uint32_t kFormat = 1;
inline constexpr std::size_t kRecordHeadBytes = 28, kEndBytes = 16;
inline constexpr std::size_t kMostPlain = std::size_t{16} << 20;  ///< bytes of a record, coded or not
inline constexpr std::size_t kMostText = 4096;                    ///< bytes
inline constexpr std::size_t kMostSegments = 1 << 17, kMostWindows = 1 << 10;
static_assert(kMostPlain <= wire::kMostCodedBatch);

enum class RecordKind : std::uint32_t { segment = 1, batch = 2, part = 3, index = 4 };

using Time = std::chrono::microseconds;

/// Of a recording as a whole.
struct Header {
    std::uint32_t stream = 0;             ///< glapi::kStreamVersion of the program that was recorded
    std::chrono::microseconds started{};  ///< since 1970
    std::string program, creator;         ///< for people
};

/// Where reading can begin.
struct Segment {
    std::uint64_t offset = 0;  ///< of its record, bytes from the file's beginning
    Time time{};
    std::uint64_t frame = 0;  ///< frames that came before
    bool operator==(const Segment&) const = default;
};

/// A window that was drawn to; its last size, pixels.
struct Window {
    SurfaceId surface;
    std::uint32_t width = 0, height = 0;
    bool operator==(const Window&) const = default;
};

struct Index {
    Time duration{};
    std::uint64_t frames = 0;       ///< of all windows together
    std::uint64_t batch_bytes = 0;  ///< as they came, not coded
    std::vector<Segment> segments;
    std::vector<Window> windows;
    bool operator==(const Index&) const = default;
};

/// What stands in front of a record's bytes.
struct RecordHead {
    RecordKind kind{};
    std::uint32_t plain_bytes = 0, coded_bytes = 0;
    Time time{};
    std::uint32_t checksum = 0;
};

/// CRC-32 (IEEE 802.3); `before`: of what stands before these bytes.
std::uint32_t checksum(std::span<const std::byte> bytes, std::uint32_t before = 0);

std::vector<std::byte> encode(const Header& header);
/// What is wrong with the header is said as for the file's user; `bytes` may be more than it. Gives its length, too.
Result<std::pair<Header, std::size_t>> decode_header(std::span<const std::byte> bytes);

/// With its checksum, over these coded bytes.
std::array<std::byte, kRecordHeadBytes> encode(const RecordHead& head, std::span<const std::byte> coded);
/// Refuses what no recorder writes.
Result<RecordHead> decode_record_head(std::span<const std::byte, kRecordHeadBytes> bytes);
/// Whether its checksum is that of the head and these bytes.
bool is_whole(std::span<const std::byte, kRecordHeadBytes> head, std::span<const std::byte> coded);

std::vector<std::byte> encode(const Index& index);
Result<Index> decode_index(std::span<const std::byte> bytes);

std::array<std::byte, kEndBytes> encode_end(std::uint64_t index_offset);
/// Of the index; nothing: this is no end.
std::optional<std::uint64_t> decode_end(std::span<const std::byte, kEndBytes> bytes);

}  // namespace wall::recording
