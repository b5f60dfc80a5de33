// SPDX-License-Identifier: MIT
#include "common/codec/huffyuv_statistics.h"

#include <algorithm>
#include <cmath>

#include "common/codec/huffyuv_rows.h"

namespace wall::codec::huffyuv {
namespace {

using Counts = std::array<std::array<std::uint32_t, 256>, 3>;

// The three codes of a pixel and one of alpha must fit what the encoder writes at once: 32 bits and again 32.
constexpr std::array<unsigned, 3> kLimits{11, 11, 10};
constexpr std::uint32_t kRowStep = 4;     ///< every fourth row is counted
constexpr double kPriorShare = 1.0 / 64;  ///< what later frames may hold and the first one has not, of all counts

Counts count_rgb(const FrameView& frame, bool alpha, Predictor predictor, bool decorrelate) {
    Counts counts{};
    std::vector<std::uint32_t> residuals(frame.width);
    const std::size_t red = frame.layout == PixelLayout::rgba ? 0 : 16, blue = 16 - red;
    for (std::uint32_t coded = frame.height > 1 ? 1 : 0; coded < frame.height; coded += kRowStep) {
        rgb_residuals(frame, coded, predictor, decorrelate, residuals.data());
        for (const std::uint32_t r : residuals) {
            ++counts[0][r >> blue & 255];
            ++counts[1][r >> 8 & 255];
            ++counts[2][r >> red & 255];
            if (alpha) ++counts[2][r >> 24];
        }
    }
    return counts;
}

Counts count_yuy2(const FrameView& frame, Predictor predictor) {
    Counts counts{};
    Yuy2Residuals residuals(frame, predictor);
    for (std::uint32_t y = 0; y < frame.height; ++y) {
        const auto& row = residuals.next();
        for (std::size_t i = 0; i < row.size(); ++i) ++counts[plane_of(i)][row[i]];
    }
    return counts;
}

/// Adds a share of small residuals to every table, and 1 to every symbol, so that any later frame can be coded.
void add_prior(Counts& counts) {
    for (auto& table : counts) {
        double total = 0, weights = 0;
        for (const auto count : table) total += count;
        const auto weight = [](int symbol) { return 1.0 / (1 + std::pow(std::min(symbol, 256 - symbol), 2) / 4); };
        for (int symbol = 0; symbol < 256; ++symbol) weights += weight(symbol);
        for (int symbol = 0; symbol < 256; ++symbol)
            table[static_cast<std::size_t>(symbol)] +=
                1 + static_cast<std::uint32_t>(total * kPriorShare * weight(symbol) / weights);
    }
}

struct Choice {
    Tables tables;
    double bits = 0;  ///< of what was counted
};

Choice tables_for(Counts counts) {
    const Counts counted = counts;
    add_prior(counts);
    Choice out;
    for (std::size_t plane = 0; plane < counts.size(); ++plane) {
        const auto codes = canonical_codes(huffman_lengths(counts[plane], kLimits[plane]));
        std::copy(codes->begin(), codes->end(), out.tables[plane].begin());
        for (std::size_t symbol = 0; symbol < 256; ++symbol)
            out.bits += static_cast<double>(counted[plane][symbol]) * out.tables[plane][symbol].length;
    }
    return out;
}

std::vector<Predictor> candidates(const FrameView& frame, const EncoderOptions& options) {
    if (options.predictor) return {*options.predictor};
    if (frame.layout == PixelLayout::yuy2 && frame.width % 4 == 0)
        return {Predictor::left, Predictor::gradient, Predictor::median};
    return {Predictor::left, Predictor::gradient};
}

}  // namespace

Stream suit(const FrameView& frame, bool alpha, const EncoderOptions& options) {
    const bool yuy2 = frame.layout == PixelLayout::yuy2;
    Stream stream{.pixels = yuy2    ? Pixels::yuy2
                            : alpha ? Pixels::rgb32
                                    : Pixels::rgb24,
                  .decorrelate = options.decorrelate && !yuy2,
                  .classic = options.classic};
    double least = INFINITY;
    for (const Predictor predictor : candidates(frame, options)) {
        const auto choice =
            tables_for(yuy2 ? count_yuy2(frame, predictor) : count_rgb(frame, alpha, predictor, stream.decorrelate));
        if (choice.bits >= least) continue;
        least = choice.bits;
        stream.predictor = predictor;
        stream.tables = options.classic ? classic_tables(stream.pixels) : choice.tables;
    }
    if (stream.classic && !yuy2 && stream.predictor == Predictor::gradient)
        stream.decorrelate = true;  // 1.x has no other
    return stream;
}

}  // namespace wall::codec::huffyuv
