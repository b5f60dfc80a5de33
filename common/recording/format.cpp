// SPDX-License-Identifier: MIT
#include "common/recording/format.h"

#include <algorithm>
#include <cstring>

#include "common/wire/operand_reader.h"

namespace wall::recording {
namespace {

constexpr std::uint32_t kPolynomial = 0xedb88320;
constexpr std::size_t kChecksumAt = kRecordHeadBytes - sizeof(std::uint32_t);

constexpr std::array<std::uint32_t, 256> make_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        std::uint32_t value = i;
        for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? kPolynomial : 0);
        table[i] = value;
    }
    return table;
}
constexpr auto kTable = make_table();

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

template <class T>
void put(std::vector<std::byte>& to, const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    to.insert(to.end(), bytes.begin(), bytes.end());
}

void put_text(std::vector<std::byte>& to, std::string_view text) {
    const auto bytes = bytes_of(text.substr(0, kMostText));
    put(to, static_cast<std::uint32_t>(bytes.size()));
    to.insert(to.end(), bytes.begin(), bytes.end());
}

std::string get_text(wire::OperandReader& from) {
    const std::size_t size = from.get<std::uint32_t>();
    if (size > kMostText) from.fail();
    const auto bytes = from.raw(from.ok() ? size : 0);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool begins_with(std::span<const std::byte> bytes, std::string_view mark) {
    return bytes.size() >= mark.size() && std::memcmp(bytes.data(), mark.data(), mark.size()) == 0;
}

}  // namespace

std::uint32_t checksum(std::span<const std::byte> bytes, std::uint32_t before) {
    std::uint32_t value = ~before;
    for (const std::byte byte : bytes)
        value = (value >> 8) ^ kTable[(value ^ std::to_integer<std::uint32_t>(byte)) & 0xff];
    return ~value;
}

// ---- header ----

std::vector<std::byte> encode(const Header& header) {
    const auto magic = bytes_of(kMagic);
    std::vector<std::byte> out(magic.begin(), magic.end());
    put(out, kFormat);
    put(out, header.stream);
    put(out, static_cast<std::uint64_t>(header.started.count()));
    put_text(out, header.program);
    put_text(out, header.creator);
    put(out, checksum(out));
    return out;
}

Result<std::pair<Header, std::size_t>> decode_header(std::span<const std::byte> bytes) {
    if (!begins_with(bytes, kMagic)) return fail("this is no recording of commands (wallctl record --commands)");
    wire::OperandReader in(bytes.subspan(kMagic.size()));
    const auto format = in.get<std::uint32_t>();
    if (in.ok() && format != kFormat)
        return fail("a recording of format " + std::to_string(format) + "; this WallGL reads format " +
                    std::to_string(kFormat));
    Header header;
    header.stream = in.get<std::uint32_t>();
    header.started = std::chrono::microseconds(in.get<std::uint64_t>());
    header.program = get_text(in);
    header.creator = get_text(in);
    const std::size_t summed = bytes.size() - in.remaining();
    const auto sum = in.get<std::uint32_t>();
    if (!in.ok()) return fail("at byte " + std::to_string(kMagic.size()) + ": the header is cut short");
    if (sum != checksum(bytes.first(summed)))
        return fail("at byte 0: the header is damaged (its checksum is another one)");
    return std::pair{std::move(header), summed + sizeof sum};
}

// ---- records ----

std::array<std::byte, kRecordHeadBytes> encode(const RecordHead& head, std::span<const std::byte> coded) {
    std::array<std::byte, kRecordHeadBytes> out;
    const std::uint32_t words[] = {static_cast<std::uint32_t>(head.kind), head.plain_bytes, head.coded_bytes};
    const auto time = static_cast<std::uint64_t>(head.time.count());
    std::memcpy(out.data(), kRecordMark.data(), kRecordMark.size());
    std::memcpy(out.data() + kRecordMark.size(), words, sizeof words);
    std::memcpy(out.data() + kRecordMark.size() + sizeof words, &time, sizeof time);
    const std::uint32_t sum = checksum(coded, checksum(std::span(out).first(kChecksumAt)));
    std::memcpy(out.data() + kChecksumAt, &sum, sizeof sum);
    return out;
}

Result<RecordHead> decode_record_head(std::span<const std::byte, kRecordHeadBytes> bytes) {
    if (!begins_with(bytes, kRecordMark)) return fail("expected a record");
    wire::OperandReader in(bytes.subspan(kRecordMark.size()));
    const auto kind = in.get<std::uint32_t>();
    RecordHead head{.kind = static_cast<RecordKind>(kind)};
    head.plain_bytes = in.get<std::uint32_t>();
    head.coded_bytes = in.get<std::uint32_t>();
    const auto time = in.get<std::uint64_t>();
    head.checksum = in.get<std::uint32_t>();
    if (kind < static_cast<std::uint32_t>(RecordKind::segment) || kind > static_cast<std::uint32_t>(RecordKind::index))
        return fail("a record of kind " + std::to_string(kind) + ": expected 1 to 4");
    // Of what cannot be made smaller, coding makes a little more.
    if (head.plain_bytes > kMostPlain || head.coded_bytes > 2 * kMostPlain)
        return fail("a record of " + std::to_string(std::max(head.plain_bytes, head.coded_bytes)) + " bytes, at most " +
                    std::to_string(kMostPlain) + " are allowed");
    constexpr auto kLongest = std::chrono::duration_cast<Time>(std::chrono::hours(24 * 366));
    if (time > static_cast<std::uint64_t>(kLongest.count())) return fail("a record of a time that cannot be");
    head.time = Time(time);
    return head;
}

bool is_whole(std::span<const std::byte, kRecordHeadBytes> head, std::span<const std::byte> coded) {
    const auto sum = wire::load<std::uint32_t>(head.data() + kChecksumAt);
    return sum == checksum(coded, checksum(head.first(kChecksumAt)));
}

// ---- index ----

std::vector<std::byte> encode(const Index& index) {
    std::vector<std::byte> out;
    put(out, static_cast<std::uint64_t>(index.duration.count()));
    put(out, index.frames);
    put(out, index.batch_bytes);
    put(out, static_cast<std::uint32_t>(index.segments.size()));
    for (const Segment& segment : index.segments) {
        put(out, segment.offset);
        put(out, static_cast<std::uint64_t>(segment.time.count()));
        put(out, segment.frame);
    }
    put(out, static_cast<std::uint32_t>(index.windows.size()));
    for (const Window& window : index.windows) {
        put(out, window.surface.value);
        put(out, window.width);
        put(out, window.height);
    }
    return out;
}

Result<Index> decode_index(std::span<const std::byte> bytes) {
    wire::OperandReader in(bytes);
    Index index;
    index.duration = Time(in.get<std::uint64_t>());
    index.frames = in.get<std::uint64_t>();
    index.batch_bytes = in.get<std::uint64_t>();
    const std::size_t segments = in.get<std::uint32_t>();
    if (segments > kMostSegments) return fail("an index of " + std::to_string(segments) + " segments");
    for (std::size_t i = 0; i < segments && in.ok(); ++i) {
        Segment segment{.offset = in.get<std::uint64_t>()};
        segment.time = Time(in.get<std::uint64_t>());
        segment.frame = in.get<std::uint64_t>();
        index.segments.push_back(segment);
    }
    const std::size_t windows = in.get<std::uint32_t>();
    if (windows > kMostWindows) return fail("an index of " + std::to_string(windows) + " windows");
    for (std::size_t i = 0; i < windows && in.ok(); ++i) {
        Window window{.surface = SurfaceId(in.get<std::uint32_t>())};
        window.width = in.get<std::uint32_t>();
        window.height = in.get<std::uint32_t>();
        index.windows.push_back(window);
    }
    if (!in.ok() || in.remaining() != 0) return fail("an index of another size than it says");
    return index;
}

std::array<std::byte, kEndBytes> encode_end(std::uint64_t index_offset) {
    std::array<std::byte, kEndBytes> out;
    std::memcpy(out.data(), &index_offset, sizeof index_offset);
    std::memcpy(out.data() + sizeof index_offset, kEndMark.data(), kEndMark.size());
    return out;
}

std::optional<std::uint64_t> decode_end(std::span<const std::byte, kEndBytes> bytes) {
    if (!begins_with(bytes.subspan(sizeof(std::uint64_t)), kEndMark)) return std::nullopt;
    return wire::load<std::uint64_t>(bytes.data());
}

}  // namespace wall::recording
