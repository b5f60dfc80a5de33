// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "common/codec/avi.h"
#include "common/codec/frame.h"

namespace wall::codec {
namespace {

constexpr std::uint64_t kMaxExtradata = 64 << 10;  ///< bytes; HuffYUV's tables take under 1 KiB
constexpr std::size_t kBitmapInfoHeader = 40;
constexpr int kMaxDepth = 4;  ///< lists within the header list

std::string text_of(const std::array<char, 4>& id) {
    std::string out(id.data(), id.size());
    std::replace_if(
        out.begin(), out.end(), [](char c) { return c < 32 || c > 126; }, '?');
    return out;
}

template <class Value>
Value number_at(std::span<const std::byte> bytes, std::size_t at) {
    Value value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

/// "NNdc" or "NNdb", NN being the stream's number.
bool is_frame_of(const std::array<char, 4>& id, int stream) {
    return id[0] == '0' + stream / 10 && id[1] == '0' + stream % 10 && id[2] == 'd' && (id[3] == 'c' || id[3] == 'b');
}

}  // namespace

Result<AviReader> AviReader::open(const std::string& path) {
    auto file = std::make_unique<std::ifstream>(path, std::ios::binary);
    if (!*file) return fail(path + ": cannot be read: " + std::strerror(errno));
    return open(std::move(file), path);
}

Result<AviReader> AviReader::open(std::unique_ptr<std::istream> file, std::string name) {
    AviReader out;
    out.file_ = std::move(file);
    out.name_ = std::move(name);
    out.file_->seekg(0, std::ios::end);
    const auto size = out.file_->tellg();
    if (size < 0) return fail(out.name_ + ": cannot be read");
    out.size_ = static_cast<std::uint64_t>(size);
    if (auto good = out.read_headers(); !good) return fail(out.name_ + ": " + good.error().message);
    return out;
}

Result<std::optional<std::vector<std::byte>>> AviReader::next() {
    while (at_ < size_) {
        const auto chunk = chunk_at(at_);
        if (!chunk) return cut();
        const std::string id(chunk->id.data(), 4);
        if (id == "RIFF" || (id == "LIST" && list_type(*chunk) != "JUNK")) {
            at_ = chunk->data_at + 4;  // into it: what follows is in it or after it
            continue;
        }
        if (chunk->bytes > size_ - chunk->data_at) return cut();
        at_ = chunk->data_at + chunk->bytes + chunk->bytes % 2;
        if (!is_frame_of(chunk->id, video_)) continue;
        std::vector<std::byte> frame(chunk->bytes);
        if (!read(chunk->data_at, frame))
            return fail(name_ + ": cannot be read at byte " + std::to_string(chunk->data_at));
        ++frames_read_;
        return frame;
    }
    if (frames_read_ < frames_promised_ || frames_promised_ == 0) return cut();
    return std::nullopt;
}

tl::unexpected<Error> AviReader::cut() const {
    const std::string promised = frames_promised_ == 0 ? " whole frames; it was not finished"
                                                       : " of " + std::to_string(frames_promised_) + " frames";
    return fail(name_ + ": cut short at byte " + std::to_string(size_) + " after " + std::to_string(frames_read_) +
                promised);
}

bool AviReader::read(std::uint64_t at, std::span<std::byte> to) {
    file_->clear();
    file_->seekg(static_cast<std::streamoff>(at));
    file_->read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
    return static_cast<std::size_t>(file_->gcount()) == to.size();
}

std::optional<AviReader::Chunk> AviReader::chunk_at(std::uint64_t at) {
    std::array<std::byte, 8> head;
    if (size_ < 8 || at > size_ - 8 || !read(at, head)) return std::nullopt;
    Chunk out{{}, at + 8, number_at<std::uint32_t>(head, 4)};
    std::memcpy(out.id.data(), head.data(), 4);
    return out;
}

std::string AviReader::list_type(const Chunk& list) {
    std::array<std::byte, 4> type{};
    read(list.data_at, type);
    return {reinterpret_cast<const char*>(type.data()), 4};
}

Result<void> AviReader::read_headers() {
    const auto riff = chunk_at(0);
    if (!riff || text_of(riff->id) != "RIFF" || list_type(*riff) != "AVI ")
        return fail("not an AVI file: expected RIFF, size, 'AVI '");
    at_ = riff->data_at + 4;
    const auto headers = chunk_at(at_);
    if (!headers || text_of(headers->id) != "LIST" || list_type(*headers) != "hdrl")
        return fail("no header list at byte " + std::to_string(at_));
    if (headers->bytes < 4 || headers->bytes > size_ - headers->data_at)
        return fail("cut short in the header list, at byte " + std::to_string(size_));
    const std::uint64_t end = headers->data_at + headers->bytes;
    if (auto good = read_header_list(headers->data_at + 4, end, 0); !good) return good;
    at_ = end + end % 2;
    if (video_ < 0 || video_ > 99) return fail("no video stream in the header list");
    return {};
}

Result<void> AviReader::read_header_list(std::uint64_t from, std::uint64_t to, int depth) {
    for (std::uint64_t at = from; at + 8 <= to;) {
        const auto chunk = chunk_at(at);
        if (!chunk || chunk->bytes > to - chunk->data_at)
            return fail("a header chunk at byte " + std::to_string(at) + " goes beyond its list");
        const std::string id = text_of(chunk->id);
        std::array<std::byte, 56> head{};
        read(chunk->data_at, std::span(head).first(std::min<std::uint64_t>(chunk->bytes, head.size())));
        if (id == "LIST" && chunk->bytes >= 4 && depth < kMaxDepth) {
            if (auto good = read_header_list(chunk->data_at + 4, chunk->data_at + chunk->bytes, depth + 1); !good)
                return good;
        } else if (id == "strh") {
            ++stream_;
            is_video_ = std::memcmp(head.data(), "vids", 4) == 0 && video_ < 0;
            scale_ = number_at<std::uint32_t>(head, 20), rate_ = number_at<std::uint32_t>(head, 24);
            if (is_video_)
                frames_promised_ = std::max<std::uint64_t>(frames_promised_, number_at<std::uint32_t>(head, 32));
        } else if (id == "strf" && is_video_) {
            if (auto good = read_stream_format(*chunk); !good) return good;
        } else if (id == "dmlh") {
            frames_promised_ = std::max<std::uint64_t>(frames_promised_, number_at<std::uint32_t>(head, 0));
        }
        at = chunk->data_at + chunk->bytes + chunk->bytes % 2;
    }
    return {};
}

Result<void> AviReader::read_stream_format(const Chunk& chunk) {
    if (chunk.bytes < kBitmapInfoHeader || chunk.bytes > kBitmapInfoHeader + kMaxExtradata)
        return fail("stream format of " + std::to_string(chunk.bytes) + " bytes; expected " +
                    std::to_string(kBitmapInfoHeader) + " to " + std::to_string(kBitmapInfoHeader + kMaxExtradata));
    std::vector<std::byte> bytes(chunk.bytes);
    if (!read(chunk.data_at, bytes)) return fail("the stream format cannot be read");
    const auto width = number_at<std::int32_t>(bytes, 4), height = number_at<std::int32_t>(bytes, 8);
    constexpr auto kMost = static_cast<std::int32_t>(kMaxExtent);
    if (width < 1 || width > kMost || height < 1 || height > kMost)
        return fail("video of " + std::to_string(width) + "x" + std::to_string(height) + " pixels; expected 1 to " +
                    std::to_string(kMost) + " a side");
    format_.width = static_cast<std::uint32_t>(width), format_.height = static_cast<std::uint32_t>(height);
    format_.bit_count = number_at<std::uint16_t>(bytes, 14);
    std::memcpy(format_.four_cc.data(), bytes.data() + 16, 4);
    if (rate_ > 0 && scale_ > 0) format_.rate = rate_, format_.scale = scale_;
    // biSize says how many bytes the header and what belongs to it have; some files say 40 and mean the chunk.
    format_.extradata.assign(bytes.begin() + kBitmapInfoHeader, bytes.end());
    video_ = stream_;
    is_video_ = false;
    return {};
}

}  // namespace wall::codec
