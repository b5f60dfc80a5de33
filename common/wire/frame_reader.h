// SPDX-License-Identifier: MIT
// Takes the bytes of a data stream apart into frames (common/wire/frame.h), puts batches that come in parts together,
// and decodes those that are coded. Bytes may be foreign and come in any portions; a failure is final. Pure; one
// thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/raw_bytes.h"
#include "common/base/result.h"
#include "common/wire/frame.h"
#include "common/wire/history_coder.h"

namespace wall::wire {

struct Frame {
    FrameKind kind{};
    RawBytes payload;
};

class FrameReader {
public:
    /// `limit`: the most payload bytes that a frame may have for now, and all parts of a batch together.
    explicit FrameReader(std::uint32_t limit) { set_limits(limit, limit); }
    void set_limits(std::uint32_t frame, std::uint32_t batch) {
        frame_limit_ = frame;
        batch_limit_ = batch;
    }

    /// Where the next bytes go; say with commit() how many came.
    std::span<std::byte> prepare();
    void commit(std::size_t bytes);
    /// The next whole frame, nothing if it has not all come yet, or why the stream is bad. A batch in parts is one
    /// frame, and so is one that was coded.
    Result<std::optional<Frame>> next();
    /// Memory that the next payload may go to; what it holds does not matter.
    void lend(RawBytes memory);
    /// What it was lent is not kept, unless a frame is coming into it.
    void forget_lent();
    /// Of `batch`, `coded` and `part` frames, that have come whole.
    std::uint64_t batch_frames() const { return batch_frames_; }
    /// What has come of a frame that is not whole is forgotten: it comes again from its beginning.
    void begin_frame_again();

private:
    static constexpr std::size_t kBuffer = 64 << 10;  // bytes
    static constexpr std::size_t kGrowth = 4 << 20;   // bytes; memory follows what has really come

    Result<std::optional<Frame>> advance();
    Result<void> begin_frame();
    void take(std::size_t bytes);
    Result<RawBytes> decode();

    std::uint32_t frame_limit_ = 0, batch_limit_ = 0;
    std::vector<std::byte> buffer_ = std::vector<std::byte>(kBuffer);
    std::size_t read_ = 0, filled_ = 0;  // in buffer_
    bool in_payload_ = false, direct_ = false, in_parts_ = false;
    FrameHeader header_;
    RawBytes payload_, decoded_;
    HistoryDecoder decoder_;
    std::uint64_t batch_frames_ = 0;
    std::size_t start_ = 0;           // of the frame, in payload_
    std::size_t have_ = 0, end_ = 0;  // bytes of payload_ that have come, and that will have at the frame's end
    std::optional<Error> failure_;
};

}  // namespace wall::wire
