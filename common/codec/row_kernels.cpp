// SPDX-License-Identifier: MIT
// The choice of row kernels, and those in plain C++: what the others must equal.
#include "common/codec/row_kernels.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

namespace wall::codec {
namespace {

using Pixel = std::uint32_t;

Pixel load(const std::byte* row, std::size_t i) {
    Pixel pixel;
    std::memcpy(&pixel, row + 4 * i, sizeof pixel);
    return pixel;
}
void store(std::byte* row, std::size_t i, Pixel pixel) { std::memcpy(row + 4 * i, &pixel, sizeof pixel); }

/// Applies `byte(a, b, c)` to each of the four bytes.
template <class Byte>
Pixel by_bytes(Pixel a, Pixel b, Pixel c, Byte byte) {
    Pixel out = 0;
    for (unsigned shift = 0; shift < 32; shift += 8)
        out |= static_cast<Pixel>(
                   static_cast<std::uint8_t>(byte((a >> shift) & 255, (b >> shift) & 255, (c >> shift) & 255)))
               << shift;
    return out;
}
Pixel add(Pixel a, Pixel b) {
    return by_bytes(a, b, 0, [](unsigned x, unsigned y, unsigned) { return x + y; });
}
Pixel subtract(Pixel a, Pixel b) {
    return by_bytes(a, b, 0, [](unsigned x, unsigned y, unsigned) { return x - y; });
}
Pixel gradient_of(Pixel left, Pixel above, Pixel above_left) { return subtract(add(left, above), above_left); }
Pixel median_of(Pixel left, Pixel above, Pixel above_left) {
    return by_bytes(left, above, gradient_of(left, above, above_left), [](unsigned x, unsigned y, unsigned z) {
        return std::max(std::min(x, y), std::min(std::max(x, y), z));
    });
}
Pixel residual(Pixel pixel, Pixel prediction, bool decorrelate) {
    const Pixel r = subtract(pixel, prediction);
    const Pixel green = (r >> 8) & 255;
    return decorrelate ? subtract(r, green | green << 16) : r;
}

template <Pixel (*predict)(Pixel, Pixel, Pixel)>
void residuals(Pixel* out, const std::byte* row, const std::byte* above, std::size_t count, RowStart start,
               bool decorrelate) {
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = residual(load(row, i), predict(start.left, load(above, i), start.above_left), decorrelate);
        start = {load(row, i), load(above, i)};
    }
}
template <Pixel (*predict)(Pixel, Pixel, Pixel)>
void restore(std::byte* row, const Pixel* residuals, const std::byte* above, std::size_t count, RowStart start) {
    for (std::size_t i = 0; i < count; ++i) {
        const Pixel pixel = add(residuals[i], predict(start.left, load(above, i), start.above_left));
        start = {pixel, load(above, i)};
        store(row, i, pixel);
    }
}
Pixel first_of(Pixel left, Pixel, Pixel) { return left; }

unsigned reached_powers(unsigned byte) { return static_cast<unsigned>(std::bit_width(byte < 128 ? byte : 256 - byte)); }

constexpr RowKernels kPlain{
    .name = "plain",
    .left = [](Pixel* out, const std::byte* row, std::size_t count, RowStart start,
               bool decorrelate) { residuals<first_of>(out, row, row, count, start, decorrelate); },
    .gradient = residuals<gradient_of>,
    .median = residuals<median_of>,
    .difference =
        [](Pixel* out, const std::byte* row, const std::byte* previous, std::size_t count, bool decorrelate) {
            for (std::size_t i = 0; i < count; ++i) out[i] = residual(load(row, i), load(previous, i), decorrelate);
        },
    .add_left =
        [](std::byte* row, const Pixel* residuals, std::size_t count, RowStart start) {
            for (std::size_t i = 0; i < count; ++i) store(row, i, start.left = add(start.left, residuals[i]));
        },
    .add_gradient = restore<gradient_of>,
    .add_median = restore<median_of>,
    .add_difference =
        [](std::byte* row, const Pixel* residuals, const std::byte* previous, std::size_t count) {
            for (std::size_t i = 0; i < count; ++i) store(row, i, add(load(previous, i), residuals[i]));
        },
    .nonzero =
        [](const Pixel* residuals, std::size_t count, Pixel mask) {
            std::uint64_t bits = 0;
            for (std::size_t i = 0; i < count; ++i) bits |= std::uint64_t{(residuals[i] & mask) != 0} << i;
            return bits;
        },
    .cost =
        [](const Pixel* residuals, std::size_t count, Pixel mask) {
            Pixel sum = 0;
            for (std::size_t i = 0; i < count; ++i) {
                const Pixel r = residuals[i] & mask;
                sum += r != 0 ? 3 : 0;
                for (unsigned shift = 0; shift < 32; shift += 8)
                    sum += std::min(reached_powers((r >> shift) & 255), 7u);
            }
            return sum;
        },
    .all_equal =
        [](const std::byte* row, std::size_t count, Pixel pixel, Pixel mask) {
            for (std::size_t i = 0; i < count; ++i)
                if ((load(row, i) ^ pixel) & mask) return false;
            return true;
        },
};

std::vector<const RowKernels*> find_kernels() {
    std::vector<const RowKernels*> out{&kPlain, &base_row_kernels()};
#if WALL_HAS_AVX2_KERNELS
    if (__builtin_cpu_supports("avx2")) out.push_back(&avx2_row_kernels());
#endif
    return out;
}

}  // namespace

std::span<const RowKernels* const> all_row_kernels() {
    static const auto kernels = find_kernels();
    return kernels;
}

const RowKernels& row_kernels() {
    static const RowKernels& best = *all_row_kernels().back();
    return best;
}

}  // namespace wall::codec
