// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <string_view>

#include "common/base/assert.h"
#include "common/codec/avi.h"

namespace wall::codec {
namespace {

constexpr std::uint32_t kMaxSegments = 512;    ///< entries kept free in the super index: half a tebibyte
constexpr std::uint64_t kMaxFrame = 1u << 30;  ///< bytes; a chunk's size has 32 bits, and old readers take it as signed
constexpr std::uint32_t kHasIndex = 0x10, kKeyFrame = 0x10, kNoKeyFrame = 0x80000000u;
constexpr std::string_view kFrameId = "00dc", kIndexId = "ix00";

/// Little-endian bytes in a row.
class LittleEndian {
public:
    LittleEndian& text(std::string_view text) {
        for (const char c : text) out_.push_back(static_cast<std::byte>(c));
        return *this;
    }
    template <class Value>
    LittleEndian& number(Value value) {
        for (std::size_t i = 0; i < sizeof(Value); ++i)
            out_.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i)));
        return *this;
    }
    LittleEndian& u16(std::uint64_t value) { return number(static_cast<std::uint16_t>(value)); }
    LittleEndian& u32(std::uint64_t value) { return number(static_cast<std::uint32_t>(value)); }
    LittleEndian& zeros(std::size_t count) {
        out_.resize(out_.size() + count);
        return *this;
    }
    LittleEndian& bytes(std::span<const std::byte> bytes) {
        out_.insert(out_.end(), bytes.begin(), bytes.end());
        return *this;
    }
    /// A chunk, padded to an even size.
    LittleEndian& chunk(std::string_view id, const LittleEndian& data) {
        return text(id).u32(data.out_.size()).bytes(data.out_).zeros(data.out_.size() % 2);
    }
    std::size_t size() const { return out_.size(); }
    std::span<const std::byte> span() const { return out_; }

private:
    std::vector<std::byte> out_;
};

LittleEndian main_header(const AviFormat& format) {
    const std::uint64_t microseconds = std::uint64_t{1000000} * format.scale / format.rate;
    LittleEndian out;
    out.u32(microseconds)
        .u32(0)
        .u32(0)
        .u32(kHasIndex)
        .u32(0)
        .u32(0)
        .u32(1)
        .u32(0)
        .u32(format.width)
        .u32(format.height)
        .zeros(16);
    return out;
}

LittleEndian stream_header(const AviFormat& format) {
    LittleEndian out;
    out.text("vids")
        .text({format.four_cc.data(), 4})
        .u32(0)
        .u32(0)
        .u32(0)
        .u32(format.scale)
        .u32(format.rate)
        .u32(0)
        .u32(0)
        .u32(0);
    out.u32(~0u).u32(0).u16(0).u16(0).u16(format.width).u16(format.height);
    return out;
}

LittleEndian stream_format(const AviFormat& format) {
    const std::uint64_t image = std::uint64_t{format.width} * format.height * ((format.bit_count + 7) / 8);
    LittleEndian out;
    out.u32(40 + format.extradata.size()).u32(format.width).u32(format.height).u16(1).u16(format.bit_count);
    out.text({format.four_cc.data(), 4}).u32(std::min<std::uint64_t>(image, ~0u)).zeros(16).bytes(format.extradata);
    return out;
}

}  // namespace

Result<AviWriter> AviWriter::create(const std::string& path, const AviFormat& format, std::uint64_t segment_bytes) {
    WALL_ASSERT(format.rate > 0 && format.scale > 0 && format.width > 0 && format.height > 0);
    AviWriter out;
    out.path_ = path;
    out.format_ = format;
    out.segment_bytes_ = std::min(segment_bytes, kSegmentBytes);
    out.file_.open(path, std::ios::binary | std::ios::trunc);
    if (!out.file_) return fail(path + ": cannot be made: " + std::strerror(errno));
    out.write_header();
    if (auto good = out.good(); !good) return tl::unexpected(good.error());
    return out;
}

Result<void> AviWriter::add(std::span<const std::byte> frame, bool key) {
    WALL_ASSERT(!finished_);
    if (frame.size() > kMaxFrame)
        return fail(path_ + ": frame of " + std::to_string(frame.size()) + " bytes; the limit is " +
                    std::to_string(kMaxFrame));
    const std::uint64_t after =
        at_ - riff_at_ + frame.size() + 8 + 32 + 24 * (entries_.size() + 1);  // with its indexes
    if (!entries_.empty() && after > segment_bytes_) {
        if (segments_.size() + 1 >= kMaxSegments)
            return fail(path_ + ": full: " + std::to_string(kMaxSegments) + " segments of " +
                        std::to_string(segment_bytes_) + " bytes");
        end_segment();
        begin_segment();
    }
    entries_.push_back({static_cast<std::uint32_t>(at_ + 8 - movi_at_), static_cast<std::uint32_t>(frame.size()), key});
    LittleEndian head;
    head.text(kFrameId).u32(frame.size());
    write(head.span());
    write(frame);
    if (frame.size() % 2 != 0) write(std::array{std::byte{0}});
    largest_ = std::max<std::uint64_t>(largest_, frame.size());
    ++frames_;
    return good();
}

Result<void> AviWriter::finish() {
    if (std::exchange(finished_, true)) return good();
    end_segment();
    std::uint64_t entry = super_index_at_ + 32;
    for (const Segment& segment : segments_) {
        patch(entry, segment.index_at, 8);
        patch(entry + 8, segment.index_bytes, 4);
        patch(entry + 12, segment.frames, 4);
        entry += 16;
    }
    patch(super_index_at_ + 12, segments_.size(), 4);
    patch(main_frames_at_, segments_.front().frames, 4);  // of the first segment, as OpenDML wants
    patch(stream_frames_at_, frames_, 4);
    patch(total_frames_at_, frames_, 4);
    patch(stream_frames_at_ + 4, largest_, 4);
    file_.close();
    return good();
}

void AviWriter::write(std::span<const std::byte> bytes) {
    file_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    at_ += bytes.size();
}

void AviWriter::patch(std::uint64_t at, std::uint64_t value, unsigned bytes) {
    file_.seekp(static_cast<std::streamoff>(at));
    file_.write(reinterpret_cast<const char*>(&value), bytes);
    file_.seekp(static_cast<std::streamoff>(at_));
}

void AviWriter::write_header() {
    LittleEndian super_index;
    super_index.u16(4).u16(0).u32(0).text(kFrameId).zeros(12).zeros(16 * kMaxSegments);
    LittleEndian stream, headers, list, riff;
    stream.text("strl").chunk("strh", stream_header(format_)).chunk("strf", stream_format(format_));
    const std::size_t index_in_stream = stream.size();
    stream.chunk("indx", super_index);
    headers.text("hdrl").chunk("avih", main_header(format_));
    const std::size_t stream_in_headers = headers.size() + 8;
    headers.chunk("LIST", stream).chunk("LIST", LittleEndian().text("odml").chunk("dmlh", LittleEndian().zeros(248)));
    riff.text("RIFF").u32(0).text("AVI ").chunk("LIST", headers);
    constexpr std::size_t kHeaders = 12 + 8;  // bytes before the header list's own
    main_frames_at_ = kHeaders + 4 + 8 + 16;
    stream_frames_at_ = kHeaders + stream_in_headers + 4 + 8 + 32;
    super_index_at_ = kHeaders + stream_in_headers + index_in_stream;
    total_frames_at_ = riff.size() - 248;
    write(riff.span());
    LittleEndian movi;
    movi.text("LIST").u32(0).text("movi");
    movi_at_ = at_ + 8;
    write(movi.span());
}

void AviWriter::begin_segment() {
    riff_at_ = at_;
    LittleEndian out;
    out.text("RIFF").u32(0).text("AVIX").text("LIST").u32(0).text("movi");
    movi_at_ = at_ + 20;
    write(out.span());
}

void AviWriter::end_segment() {
    LittleEndian index;
    index.u16(2).u16(0x0100).u32(entries_.size()).text(kFrameId).number(movi_at_).u32(0);
    for (const Entry& entry : entries_) index.u32(entry.offset).u32(entry.bytes | (entry.key ? 0 : kNoKeyFrame));
    LittleEndian chunk;
    chunk.chunk(kIndexId, index);
    segments_.push_back({at_, static_cast<std::uint32_t>(chunk.size()), static_cast<std::uint32_t>(entries_.size())});
    write(chunk.span());
    patch(movi_at_ - 4, at_ - movi_at_, 4);
    if (segments_.size() == 1) write_old_index();
    patch(riff_at_ + 4, at_ - riff_at_ - 8, 4);
    entries_.clear();
}

void AviWriter::write_old_index() {
    LittleEndian index, chunk;
    for (const Entry& entry : entries_)
        index.text(kFrameId).u32(entry.key ? kKeyFrame : 0).u32(entry.offset - 8).u32(entry.bytes);
    chunk.chunk("idx1", index);
    write(chunk.span());
}

Result<void> AviWriter::good() const {
    if (!file_) return fail(path_ + ": cannot be written: " + std::strerror(errno));
    return {};
}

}  // namespace wall::codec
