// SPDX-License-Identifier: MIT
// Takes the bytes of a data stream apart into frames (common/wire/frame.h). Bytes may be foreign and come in any
// portions; a failure is final. Pure; one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/result.h"
#include "common/wire/frame.h"

namespace wall::tileserver {

struct Frame {
    wire::FrameKind kind{};
    std::vector<std::byte> payload;
};

class FrameReader {
public:
    /// `limit`: the most payload bytes that a frame may have for now.
    explicit FrameReader(std::uint32_t limit) : limit_(limit) {}
    void set_limit(std::uint32_t limit) { limit_ = limit; }

    /// Where the next bytes go; say with commit() how many came.
    std::span<std::byte> prepare();
    void commit(std::size_t bytes);
    /// The next whole frame, nothing if it has not all come yet, or why the stream is bad.
    Result<std::optional<Frame>> next();

private:
    static constexpr std::size_t kBuffer = 64 << 10;  // bytes
    static constexpr std::size_t kGrowth = 4 << 20;   // bytes; memory follows what has really come

    Result<void> begin_frame();
    void take(std::size_t bytes);

    std::uint32_t limit_;
    std::vector<std::byte> buffer_ = std::vector<std::byte>(kBuffer);
    std::size_t read_ = 0, filled_ = 0;  // in buffer_
    bool in_payload_ = false, direct_ = false;
    wire::FrameHeader header_;
    std::vector<std::byte> payload_;
    std::size_t have_ = 0;  // bytes of payload_ that have come
    std::optional<Error> failure_;
};

}  // namespace wall::tileserver
