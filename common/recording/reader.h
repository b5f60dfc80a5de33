// SPDX-License-Identifier: MIT
// Reads a recording (format.h), from any segment on. The file may be foreign, damaged or cut short: what is wrong is
// said with its place, and what is whole can be read. One thread.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "common/base/raw_bytes.h"
#include "common/base/result.h"
#include "common/recording/format.h"
#include "common/wire/history_coder.h"

namespace wall::recording {

/// A file's bytes: `read` fills as much of a span as there is from an offset on, and gives how much.
struct Source {
    std::uint64_t size = 0;
    std::function<Result<std::size_t>(std::uint64_t offset, std::span<std::byte> to)> read;

    static Result<Source> open(const std::string& path);
    /// The bytes outlive it.
    static Source of(std::span<const std::byte> bytes);
};

/// What comes next.
struct Record {
    RecordKind kind{};  ///< segment or batch
    Time time{};
    RawBytes payload;  ///< a batch's (common/wire/batch.h)
};

class Reader {
public:
    /// Where no whole index is, the file is read once to its end.
    static Result<Reader> open(Source source);

    const Header& header() const { return header_; }
    const Index& index() const { return index_; }
    /// Why the index had to be made from the records; none: it was there.
    const std::optional<std::string>& recovered() const { return recovered_; }

    /// Of the same file, at its beginning.
    Reader another() const;

    /// Goes on there; index().segments has it.
    void seek(std::size_t segment);
    /// Nothing: at the end. After an error only seek() helps.
    Result<std::optional<Record>> next();

private:
    explicit Reader(Source source) : source_(std::move(source)) {}
    Result<Index> read_index();
    void recover(const std::string& why);
    Result<std::optional<RecordHead>> read_record();
    tl::unexpected<Error> wrong(std::uint64_t offset, const std::string& what) const;

    Source source_;
    Header header_;
    Index index_;
    std::optional<std::string> recovered_;
    std::uint64_t first_ = 0;  ///< record
    std::uint64_t end_ = 0;    ///< of the records that are read
    std::uint64_t at_ = 0;     ///< next record
    Time last_{};
    RawBytes coded_;                               ///< of the record that was read last
    std::optional<wire::HistoryDecoder> decoder_;  ///< none: no segment has begun
};

}  // namespace wall::recording
