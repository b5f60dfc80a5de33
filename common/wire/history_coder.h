// SPDX-License-Identifier: MIT
// Makes what follows each other in a stream smaller by what came before it (A5.3, T6.2): a program draws much the same
// in every frame, so the bytes of one tell most of those of the next. Exact. The coder is zstd, its fastest level that
// looks for more than runs, with one history for the whole stream instead of one for each piece: on the golden programs
// it makes 9 bytes one (docs/benchmarks.md). Both ends keep the last 2^kHistoryLog bytes. One thread each.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "common/base/raw_bytes.h"
#include "common/base/result.h"

extern "C" {
struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;
}

namespace wall::wire {

/// Bytes that both ends remember, as a power of two: 8 MiB, a frame of most programs that send much.
inline constexpr int kHistoryLog = 23;
/// Bytes of a batch that is coded: a few coded ones may say many, and ask for as much memory.
inline constexpr std::size_t kMostCodedBatch = std::size_t{32} << 20;

class HistoryEncoder {
public:
    /// Nothing: there is no memory for it.
    static std::optional<HistoryEncoder> create();

    /// Appends to `out` what HistoryDecoder::decode() makes these pieces of, in their order. False: there is no memory
    /// for it, and the history is lost: nothing can be encoded any more.
    bool encode(std::span<const std::span<const std::byte>> pieces, RawBytes& out);

private:
    struct Free {
        void operator()(ZSTD_CCtx_s* context) const;
    };
    explicit HistoryEncoder(std::unique_ptr<ZSTD_CCtx_s, Free> context) : context_(std::move(context)) {}
    std::unique_ptr<ZSTD_CCtx_s, Free> context_;
};

class HistoryDecoder {
public:
    /// What was encoded, appended to `out`: exactly `bytes`, or an error. `coded` may be foreign; after an error the
    /// history is lost.
    Result<void> decode(std::span<const std::byte> coded, std::size_t bytes, RawBytes& out);

private:
    struct Free {
        void operator()(ZSTD_DCtx_s* context) const;
    };
    std::unique_ptr<ZSTD_DCtx_s, Free> context_;  // made when something comes
};

}  // namespace wall::wire
