// SPDX-License-Identifier: MIT
#include "common/codec/huffyuv_rows.h"

#include <algorithm>

namespace wall::codec::huffyuv {
namespace {

std::uint32_t subtract_bytes(std::uint32_t a, std::uint32_t b) {
    std::uint32_t out = 0;
    for (unsigned shift = 0; shift < 32; shift += 8) out |= (((a >> shift) - (b >> shift)) & 255) << shift;
    return out;
}

}  // namespace

void rgb_residuals(const FrameView& frame, std::uint32_t coded, Predictor predictor, bool decorrelate,
                   std::uint32_t* out) {
    const auto& kernels = row_kernels();
    const std::byte* row = coded_row(frame, coded);
    if (coded == 0) return kernels.left(out, row, frame.width, {}, decorrelate);
    const std::byte* above = coded_row(frame, coded - 1);
    const std::uint32_t last = pixel_at(above, frame.width - 1);
    if (predictor == Predictor::left) return kernels.left(out, row, frame.width, {last, 0}, decorrelate);
    // The running value that `left` goes on from is what was coded last: in row 1 a pixel, later a difference of two
    // rows.
    const std::uint32_t carried =
        coded == 1 ? last : subtract_bytes(last, pixel_at(coded_row(frame, coded - 2), frame.width - 1));
    kernels.gradient(out, row, above, frame.width, {carried, 0}, decorrelate);
}

const Yuy2Row& Yuy2Residuals::next() {
    const std::uint32_t y = y_++;
    const std::size_t samples = frame_.row_bytes();
    row_.resize(samples);
    const bool vertical = predictor_ == Predictor::gradient && y > 0;
    for (std::size_t i = 0; i < samples; ++i) {
        const auto plane = plane_of(i);
        const auto above = y > 0 ? sample(y - 1, i) : std::uint8_t{0};
        const auto value = static_cast<std::uint8_t>(sample(y, i) - (vertical ? above : 0));
        const bool by_median = predictor_ == Predictor::median && (y > 1 || (y == 1 && i >= 8));
        row_[i] = static_cast<std::uint8_t>(
            value - (by_median ? median(left_[plane], above, above_left_[plane]) : left_[plane]));
        left_[plane] = value;
        above_left_[plane] = above;
    }
    if (y == 0) std::copy_n(reinterpret_cast<const std::uint8_t*>(frame_.row(0)), 4, row_.begin());
    return row_;
}

}  // namespace wall::codec::huffyuv
