// SPDX-License-Identifier: MIT
// Prediction as HuffYUV orders it: the residuals of one row, for four-byte pixels (SIMD) and for the planes of YUY2.
// Pure; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "common/codec/frame.h"
#include "common/codec/huffyuv_format.h"
#include "common/codec/row_kernels.h"

namespace wall::codec::huffyuv {

inline constexpr std::size_t kMostPixelBytes = 16;  ///< of a coded RGB pixel: four codes of at most 31 bits
inline constexpr std::size_t kGroup = 8;  ///< pixels that are coded and found together: no residual in any is common

inline std::uint32_t pixel_at(const std::byte* row, std::size_t i) {
    std::uint32_t pixel;
    std::memcpy(&pixel, row + 4 * i, sizeof pixel);
    return pixel;
}

/// The rows of an RGB frame in coded order: the bottom one first.
inline const std::byte* coded_row(const FrameView& frame, std::uint32_t coded) {
    return frame.row(frame.height - 1 - coded);
}

/// The residuals of coded row `coded` of an RGB frame. The first pixel of the frame has none: out[0] of row 0 is not
/// used. `predictor` is not median.
void rgb_residuals(const FrameView& frame, std::uint32_t coded, Predictor predictor, bool decorrelate,
                   std::uint32_t* out);

/// Samples of one row in the order they are coded: Y U Y V ...
using Yuy2Row = std::vector<std::uint8_t>;

/// The residuals of a YUY2 frame row by row, from the top; those of row 0 begin after its first two pixels. The
/// prediction of a row goes on where the one before it ended, so that rows must be asked for in order.
class Yuy2Residuals {
public:
    Yuy2Residuals(const FrameView& frame, Predictor predictor) : frame_(frame), predictor_(predictor) {}
    /// Row 0, then 1, ...: all its samples (row 0: the first four are the samples themselves).
    const Yuy2Row& next();

private:
    std::uint8_t sample(std::uint32_t y, std::size_t i) const {
        return std::to_integer<std::uint8_t>(frame_.row(y)[i]);
    }

    const FrameView frame_;
    const Predictor predictor_;
    std::uint32_t y_ = 0;
    std::array<std::uint8_t, 3> left_{}, above_left_{};
    Yuy2Row row_;
};

/// Which of the three planes a sample of YUY2 belongs to.
inline std::size_t plane_of(std::size_t sample) { return sample % 2 == 0 ? 0 : sample % 4 == 1 ? 1 : 2; }

/// HuffYUV's median of left, above and their gradient.
inline std::uint8_t median(std::uint8_t left, std::uint8_t above, std::uint8_t above_left) {
    const auto gradient = static_cast<std::uint8_t>(left + above - above_left);
    const auto low = left < above ? left : above, high = left < above ? above : left;
    return gradient < low ? low : gradient > high ? high : gradient;
}

}  // namespace wall::codec::huffyuv
