// SPDX-License-Identifier: MIT
// Writes a recording (format.h), so that whatever ends it leaves a file that can be read as far as it goes. One thread.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "common/base/result.h"
#include "common/base/unique_fd.h"
#include "common/recording/format.h"
#include "common/wire/history_coder.h"

namespace wall::recording {

class Writer {
public:
    /// A new file, or one that is overwritten.
    static Result<Writer> create(const std::string& path, const Header& header);

    /// What follows is told from nothing. `frame`: frames so far. The first thing that is written.
    Result<void> begin_segment(Time time, std::uint64_t frame);
    /// A batch's payload. Times do not go back: an earlier one counts as the last.
    Result<void> add_batch(std::span<const std::byte> payload, Time time);
    /// With the index; nothing can be written any more. What the writer knows of it need not be filled in.
    Result<void> finish(Index index);

    std::uint64_t bytes() const { return bytes_; }              ///< of the file so far
    std::uint64_t batch_bytes() const { return batch_bytes_; }  ///< that came, before they were coded
    std::size_t segments() const { return segments_.size(); }

private:
    Writer(UniqueFd file, std::string path) : file_(std::move(file)), path_(std::move(path)) {}
    Result<void> write(std::span<const std::byte> bytes);
    Result<void> add(RecordKind kind, std::size_t plain_bytes, std::span<const std::byte> coded);

    UniqueFd file_;
    std::string path_;
    std::uint64_t bytes_ = 0, batch_bytes_ = 0;
    Time last_{};
    std::vector<Segment> segments_;
    std::optional<wire::HistoryEncoder> encoder_;  ///< of the segment
    RawBytes coded_, record_;                      ///< used again and again
};

}  // namespace wall::recording
