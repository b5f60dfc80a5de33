// SPDX-License-Identifier: MIT
#include "common/wire/history_coder.h"

#include <zstd.h>

#include <string>
#include <utility>

namespace wall::wire {
namespace {

constexpr int kLevel = 1;

}  // namespace

void HistoryEncoder::Free::operator()(ZSTD_CCtx_s* context) const { ZSTD_freeCCtx(context); }
void HistoryDecoder::Free::operator()(ZSTD_DCtx_s* context) const { ZSTD_freeDCtx(context); }

std::optional<HistoryEncoder> HistoryEncoder::create() {
    std::unique_ptr<ZSTD_CCtx_s, Free> context(ZSTD_createCCtx());
    if (!context) return std::nullopt;
    for (const auto& [parameter, value] : {std::pair{ZSTD_c_compressionLevel, kLevel},
                                           {ZSTD_c_windowLog, kHistoryLog},
                                           {ZSTD_c_contentSizeFlag, 0},
                                           {ZSTD_c_checksumFlag, 0}})  // the transport has its own
        if (ZSTD_isError(ZSTD_CCtx_setParameter(context.get(), parameter, value))) return std::nullopt;
    return HistoryEncoder(std::move(context));
}

/// Everything is one zstd frame that never ends; each call ends a block, so that the decoder gets all of it at once.
bool HistoryEncoder::encode(std::span<const std::span<const std::byte>> pieces, RawBytes& out) {
    if (!context_) return false;
    std::size_t total = 0;
    for (const auto& piece : pieces) total += piece.size();
    const std::size_t begin = out.size();
    out.resize(begin + ZSTD_compressBound(total) + ZSTD_CStreamOutSize());
    ZSTD_outBuffer to{out.data() + begin, out.size() - begin, 0};
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        ZSTD_inBuffer from{pieces[i].data(), pieces[i].size(), 0};
        const auto step = i + 1 == pieces.size() ? ZSTD_e_flush : ZSTD_e_continue;
        for (;;) {
            const std::size_t left = ZSTD_compressStream2(context_.get(), &to, &from, step);
            if (ZSTD_isError(left)) {
                context_.reset();
                out.resize(begin);
                return false;
            }
            if (from.pos == from.size && (step == ZSTD_e_continue || left == 0)) break;
        }
    }
    out.resize(begin + to.pos);
    return true;
}

Result<void> HistoryDecoder::decode(std::span<const std::byte> coded, std::size_t bytes, RawBytes& out) {
    if (!context_) {
        context_.reset(ZSTD_createDCtx());
        if (!context_ || ZSTD_isError(ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kHistoryLog)))
            return fail("coded batch: no memory to decode it");
    }
    const std::size_t begin = out.size();
    out.resize(begin + bytes + 1);  // the decoder may keep for itself what there is no room for
    ZSTD_outBuffer to{out.data() + begin, bytes + 1, 0};
    ZSTD_inBuffer from{coded.data(), coded.size(), 0};
    while (from.pos < from.size) {
        const std::size_t before = from.pos + to.pos;
        const std::size_t left = ZSTD_decompressStream(context_.get(), &to, &from);
        if (ZSTD_isError(left)) return fail(std::string("coded batch: ") + ZSTD_getErrorName(left));
        if (from.pos + to.pos == before) break;  // more comes out than was said
    }
    out.resize(begin + bytes);
    if (from.pos != from.size || to.pos != bytes)
        return fail("coded batch: expected " + std::to_string(bytes) + " bytes, and " +
                    (to.pos < bytes ? std::to_string(to.pos) : "more") + " come out");
    return {};
}

}  // namespace wall::wire
