// SPDX-License-Identifier: MIT
// The row kernels over vectors of WALL_VECTOR_BYTES bytes (GCC's and clang's vector extension: no intrinsics, any
// processor). Everything here is in an unnamed namespace and always inlined, so that no function leaves this build.
#include "common/codec/row_kernels.h"

#define WALL_INLINE inline __attribute__((always_inline))

namespace wall::codec {
namespace {

using Pixel = std::uint32_t;
constexpr std::size_t kPixels = WALL_VECTOR_BYTES / 4;
using Bytes = std::uint8_t __attribute__((vector_size(WALL_VECTOR_BYTES)));
using Words = std::uint32_t __attribute__((vector_size(WALL_VECTOR_BYTES)));
using Bytes16 = std::uint8_t __attribute__((vector_size(16)));
using Words4 = std::uint32_t __attribute__((vector_size(16)));

template <class V = Bytes>
WALL_INLINE V load(const void* from) {
    V out;
    __builtin_memcpy(&out, from, sizeof out);
    return out;
}
template <class V>
WALL_INLINE void store(void* to, V value) {
    __builtin_memcpy(to, &value, sizeof value);
}
WALL_INLINE Bytes smaller(Bytes a, Bytes b) { return a < b ? a : b; }
WALL_INLINE Bytes larger(Bytes a, Bytes b) { return a > b ? a : b; }
WALL_INLINE Bytes16 smaller(Bytes16 a, Bytes16 b, int) { return a < b ? a : b; }
WALL_INLINE Bytes16 larger(Bytes16 a, Bytes16 b, int) { return a > b ? a : b; }
WALL_INLINE Bytes16 pixel_vector(Pixel pixel) { return reinterpret_cast<Bytes16>(Words4{pixel, 0, 0, 0}); }

template <bool decorrelate>
WALL_INLINE Bytes decorrelated(Bytes r) {
    if constexpr (!decorrelate) return r;
    const Words green = (reinterpret_cast<Words>(r) >> 8) & 255;
    return r - reinterpret_cast<Bytes>(green | green << 16);
}

/// Calls `vector(i)` for vectors of pixels from `first` on and `single(i)` for the rest.
template <class Vector, class Single>
WALL_INLINE void each(std::size_t first, std::size_t count, Vector vector, Single single) {
    std::size_t i = first;
    for (; i + kPixels <= count; i += kPixels) vector(i);
    for (; i < count; ++i) single(i);
}

struct Left {
    template <class V>
    static WALL_INLINE V predict(V left, V, V) {
        return left;
    }
};
struct Gradient {
    template <class V>
    static WALL_INLINE V predict(V left, V above, V above_left) {
        return left + above - above_left;
    }
};
struct Median {
    static WALL_INLINE Bytes predict(Bytes left, Bytes above, Bytes above_left) {
        return larger(smaller(left, above), smaller(larger(left, above), left + above - above_left));
    }
};
struct Previous {
    template <class V>
    static WALL_INLINE V predict(V, V above, V) {
        return above;
    }
};

/// One pixel, in the first lane of a whole vector.
template <class Predictor, bool decorrelate>
WALL_INLINE Pixel single_residual(Pixel pixel, Pixel left, Pixel above, Pixel above_left) {
    const auto lane = [](Pixel p) { return reinterpret_cast<Bytes>(Words{p}); };
    const Bytes r =
        decorrelated<decorrelate>(lane(pixel) - Predictor::predict(lane(left), lane(above), lane(above_left)));
    return reinterpret_cast<Words>(r)[0];
}

template <class Predictor, bool decorrelate>
void residuals_as(Pixel* out, const std::byte* row, const std::byte* above, std::size_t count, RowStart start) {
    if (count == 0) return;
    out[0] =
        single_residual<Predictor, decorrelate>(load<Pixel>(row), start.left, load<Pixel>(above), start.above_left);
    const auto vector = [&](std::size_t i) {
        const Bytes predicted = Predictor::predict(load(row + 4 * i - 4), load(above + 4 * i), load(above + 4 * i - 4));
        store(out + i, decorrelated<decorrelate>(load(row + 4 * i) - predicted));
    };
    std::size_t i = 1;
    for (; i + kPixels <= count; i += kPixels) vector(i);
    // Behind the first pixel of a row of whole vectors all but one of the last vector's are left: some pixels are made
    // once more, instead of each of these by itself.
    if (i < count && count > kPixels) return vector(count - kPixels);
    for (; i < count; ++i)
        out[i] = single_residual<Predictor, decorrelate>(load<Pixel>(row + 4 * i), load<Pixel>(row + 4 * i - 4),
                                                         load<Pixel>(above + 4 * i), load<Pixel>(above + 4 * i - 4));
}

template <class Predictor>
void residuals(Pixel* out, const std::byte* row, const std::byte* above, std::size_t count, RowStart start,
               bool decorrelate) {
    if (decorrelate) residuals_as<Predictor, true>(out, row, above, count, start);
    else residuals_as<Predictor, false>(out, row, above, count, start);
}

/// Running sums over a row of differences that begins after `carry`; with `above`, that row is added to the sums.
template <bool with_above>
WALL_INLINE void sum_up(std::byte* row, const Pixel* residuals, const std::byte* above, std::size_t count,
                        Bytes16 carry) {
    const Words4 zero{};
    carry = reinterpret_cast<Bytes16>(__builtin_shufflevector(reinterpret_cast<Words4>(carry), zero, 0, 0, 0, 0));
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4) {
        Bytes16 sum = load<Bytes16>(residuals + i);
        sum += reinterpret_cast<Bytes16>(__builtin_shufflevector(reinterpret_cast<Words4>(sum), zero, 4, 0, 1, 2));
        sum += reinterpret_cast<Bytes16>(__builtin_shufflevector(reinterpret_cast<Words4>(sum), zero, 4, 4, 0, 1));
        sum += carry;
        carry = reinterpret_cast<Bytes16>(__builtin_shufflevector(reinterpret_cast<Words4>(sum), zero, 3, 3, 3, 3));
        store(row + 4 * i, with_above ? sum + load<Bytes16>(above + 4 * i) : sum);
    }
    for (; i < count; ++i) {
        carry += pixel_vector(residuals[i]);
        const Bytes16 out = with_above ? carry + pixel_vector(load<Pixel>(above + 4 * i)) : carry;
        store(row + 4 * i, reinterpret_cast<Words4>(out)[0]);
    }
}

void add_left(std::byte* row, const Pixel* residuals, std::size_t count, RowStart start) {
    sum_up<false>(row, residuals, nullptr, count, pixel_vector(start.left));
}

void add_gradient(std::byte* row, const Pixel* residuals, const std::byte* above, std::size_t count, RowStart start) {
    sum_up<true>(row, residuals, above, count, pixel_vector(start.left) - pixel_vector(start.above_left));
}

void add_median(std::byte* row, const Pixel* residuals, const std::byte* above, std::size_t count, RowStart start) {
    Bytes16 left = pixel_vector(start.left), above_left = pixel_vector(start.above_left);
    for (std::size_t i = 0; i < count; ++i) {
        const Bytes16 up = pixel_vector(load<Pixel>(above + 4 * i));
        const Bytes16 gradient = left + (up - above_left);
        left = larger(smaller(left, up, 0), smaller(larger(left, up, 0), gradient, 0), 0) + pixel_vector(residuals[i]);
        above_left = up;
        store(row + 4 * i, reinterpret_cast<Words4>(left)[0]);
    }
}

void difference(Pixel* out, const std::byte* row, const std::byte* previous, std::size_t count, bool decorrelate) {
    residuals<Previous>(out, row, previous, count, {}, decorrelate);
}

void add_difference(std::byte* row, const Pixel* residuals, const std::byte* previous, std::size_t count) {
    each(
        0, count, [&](std::size_t i) { store(row + 4 * i, load(residuals + i) + load(previous + 4 * i)); },
        [&](std::size_t i) {
            const Bytes16 sum = pixel_vector(residuals[i]) + pixel_vector(load<Pixel>(previous + 4 * i));
            store(row + 4 * i, reinterpret_cast<Words4>(sum)[0]);
        });
}

/// Bit i: lane i of a comparison's result is true.
WALL_INLINE std::uint64_t lane_bits(Words comparison) {
#if defined(__AVX2__)
    using Floats = float __attribute__((vector_size(32)));
    return static_cast<std::uint64_t>(__builtin_ia32_movmskps256(reinterpret_cast<Floats>(comparison)));
#elif defined(__SSE2__)
    using Floats = float __attribute__((vector_size(16)));
    return static_cast<std::uint64_t>(__builtin_ia32_movmskps(reinterpret_cast<Floats>(comparison)));
#else
    std::uint64_t bits = 0;
    for (std::size_t lane = 0; lane < kPixels; ++lane) bits |= std::uint64_t{comparison[lane] & 1} << lane;
    return bits;
#endif
}

std::uint64_t nonzero(const Pixel* residuals, std::size_t count, Pixel mask) {
    std::uint64_t bits = 0;
    each(
        0, count,
        [&](std::size_t i) {
            bits |= lane_bits(reinterpret_cast<Words>((load<Words>(residuals + i) & mask) != 0)) << i;
        },
        [&](std::size_t i) { bits |= std::uint64_t{(residuals[i] & mask) != 0} << i; });
    return bits;
}

constexpr std::uint8_t kBelowSteps[] = {0, 1, 3, 7, 15, 31, 63};  // the magnitudes before another bit counts

std::uint32_t cost(const Pixel* residuals, std::size_t count, Pixel mask) {
    Words sum{};
    const auto count_vector = [&](Words r) {
        r &= mask;
        const Bytes bytes = reinterpret_cast<Bytes>(r);
        const Bytes magnitude = smaller(bytes, -bytes);
        Bytes reached{};  // comparisons give 255 = -1 where true
        for (const auto below : kBelowSteps) reached -= reinterpret_cast<Bytes>(magnitude > below);
        const Words by_byte = reinterpret_cast<Words>(reached);
        sum += (by_byte & 255) + (by_byte >> 8 & 255) + (by_byte >> 16 & 255) + (by_byte >> 24);
        sum += reinterpret_cast<Words>(r != 0) & 3;
    };
    each(
        0, count, [&](std::size_t i) { count_vector(load<Words>(residuals + i)); },
        [&](std::size_t i) { count_vector(Words{residuals[i]}); });
    std::uint32_t total = 0;
    for (std::size_t lane = 0; lane < kPixels; ++lane) total += sum[lane];
    return total;
}

bool all_equal(const std::byte* row, std::size_t count, Pixel pixel, Pixel mask) {
    Words different{};
    each(
        0, count, [&](std::size_t i) { different |= load<Words>(row + 4 * i) ^ pixel; },
        [&](std::size_t i) { different[0] |= load<Pixel>(row + 4 * i) ^ pixel; });
    Pixel any = 0;
    for (std::size_t lane = 0; lane < kPixels; ++lane) any |= different[lane];
    return (any & mask) == 0;
}

}  // namespace

const RowKernels& WALL_KERNELS() {
    static constexpr RowKernels kernels{
        .name = WALL_KERNELS_NAME,
        .left = [](Pixel* out, const std::byte* row, std::size_t count, RowStart start,
                   bool decorrelate) { residuals<Left>(out, row, row, count, start, decorrelate); },
        .gradient = residuals<Gradient>,
        .median = residuals<Median>,
        .difference = difference,
        .add_left = add_left,
        .add_gradient = add_gradient,
        .add_median = add_median,
        .add_difference = add_difference,
        .nonzero = nonzero,
        .cost = cost,
        .all_equal = all_equal,
    };
    return kernels;
}

}  // namespace wall::codec
