// SPDX-License-Identifier: MIT
// AVI files with one video stream: RIFF with the OpenDML extensions (version 1.02), so that a recording may be larger
// than 4 GiB. docs/codecs.md shows the layout that is written; any such file, and any cut or unfinished one, is read.
// One thread at a time; both block on the disk.
#pragma once

#include <array>
#include <cstdint>
#include <fstream>
#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace wall::codec {

struct AviFormat {
    std::uint32_t width = 0, height = 0;  ///< pixels; at most kMaxExtent each
    std::array<char, 4> four_cc{'H', 'F', 'Y', 'U'};
    std::uint16_t bit_count = 24;        ///< biBitCount
    std::uint32_t rate = 25, scale = 1;  ///< rate / scale frames a second
    std::vector<std::byte> extradata;    ///< behind the BITMAPINFOHEADER
};

class AviWriter {
public:
    /// A file has RIFF segments of at most about this size, the first one with the index that old readers want.
    static constexpr std::uint64_t kSegmentBytes = std::uint64_t{1} << 30;

    /// Makes or empties the file. Tests give a smaller segment.
    static Result<AviWriter> create(const std::string& path, const AviFormat& format,
                                    std::uint64_t segment_bytes = kSegmentBytes);

    /// Fails when the disk is full or the file is (kMaxSegments segments); what was written stays readable after
    /// finish().
    Result<void> add(std::span<const std::byte> frame, bool key = true);
    /// Writes the indexes and sizes. Without it the file is one that was cut short.
    Result<void> finish();
    std::uint64_t frames() const { return frames_; }

private:
    struct Entry {
        std::uint32_t offset;  ///< of the data, from the segment's movi list
        std::uint32_t bytes;
        bool key;
    };
    struct Segment {
        std::uint64_t index_at;
        std::uint32_t index_bytes, frames;
    };
    AviWriter() = default;
    void write(std::span<const std::byte> bytes);
    void patch(std::uint64_t at, std::uint64_t value, unsigned bytes);
    void write_header();
    void begin_segment();
    void end_segment();
    void write_old_index();
    Result<void> good() const;

    std::string path_;
    AviFormat format_;
    std::uint64_t segment_bytes_ = kSegmentBytes;
    std::ofstream file_;
    std::uint64_t at_ = 0, frames_ = 0, riff_at_ = 0, movi_at_ = 0, largest_ = 0;
    std::uint64_t super_index_at_ = 0, total_frames_at_ = 0, main_frames_at_ = 0, stream_frames_at_ = 0;
    std::vector<Entry> entries_;  ///< of the open segment
    std::vector<Segment> segments_;
    bool finished_ = false;
};

class AviReader {
public:
    static Result<AviReader> open(const std::string& path);
    /// `name` begins every error. Fails when the headers are not whole or show no video.
    static Result<AviReader> open(std::unique_ptr<std::istream> file, std::string name);

    const AviFormat& format() const { return format_; }
    /// The next frame's bytes, nothing at the end. Fails where the file is cut (every whole frame before that was
    /// given) and where it is not RIFF any more.
    Result<std::optional<std::vector<std::byte>>> next();

private:
    struct Chunk {
        std::array<char, 4> id;
        std::uint64_t data_at, bytes;
    };
    AviReader() = default;
    bool read(std::uint64_t at, std::span<std::byte> to);
    std::optional<Chunk> chunk_at(std::uint64_t at);
    std::string list_type(const Chunk& list);
    Result<void> read_headers();
    Result<void> read_header_list(std::uint64_t from, std::uint64_t to, int depth);
    Result<void> read_stream_format(const Chunk& chunk);
    tl::unexpected<Error> cut() const;

    std::unique_ptr<std::istream> file_;
    std::string name_;
    AviFormat format_;
    std::uint64_t size_ = 0, at_ = 0;
    std::uint64_t frames_read_ = 0, frames_promised_ = 0;  ///< promised 0: the file was not finished
    int stream_ = -1;                                      ///< streams seen so far, less 1
    int video_ = -1;                                       ///< the video stream's number
    bool is_video_ = false;                                ///< of the stream list that is read
    std::uint32_t rate_ = 0, scale_ = 0;
};

}  // namespace wall::codec
