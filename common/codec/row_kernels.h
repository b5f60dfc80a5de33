// SPDX-License-Identifier: MIT
// The work on whole rows that SIMD does: residuals of four-byte pixels and their inverses. Several builds of the same
// functions, chosen once at run time; all give the same bytes (tests/unit/codec). Pure; any thread.
//
// A residual is, byte by byte and modulo 256, the pixel less its prediction. `decorrelated` residuals then have the
// bytes 0 and 2 (blue and red) less byte 1 (green). Pixels are four bytes in memory order, held as little-endian
// numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace wall::codec {

/// The pixel before a row's first one, and the one above that.
struct RowStart {
    std::uint32_t left = 0, above_left = 0;
};

struct RowKernels {
    std::string_view name;

    // Residuals of `count` pixels at `row`; `above` and `previous` are rows alike, `out` lies apart from all of them.
    // Decorrelated if `decorrelate`.
    void (*left)(std::uint32_t* out, const std::byte* row, std::size_t count, RowStart start, bool decorrelate);
    void (*gradient)(std::uint32_t* out, const std::byte* row, const std::byte* above, std::size_t count,
                     RowStart start, bool decorrelate);
    void (*median)(std::uint32_t* out, const std::byte* row, const std::byte* above, std::size_t count, RowStart start,
                   bool decorrelate);
    void (*difference)(std::uint32_t* out, const std::byte* row, const std::byte* previous, std::size_t count,
                       bool decorrelate);

    // The inverses; residuals are not decorrelated.
    void (*add_left)(std::byte* row, const std::uint32_t* residuals, std::size_t count, RowStart start);
    void (*add_gradient)(std::byte* row, const std::uint32_t* residuals, const std::byte* above, std::size_t count,
                         RowStart start);
    void (*add_median)(std::byte* row, const std::uint32_t* residuals, const std::byte* above, std::size_t count,
                       RowStart start);
    void (*add_difference)(std::byte* row, const std::uint32_t* residuals, const std::byte* previous,
                           std::size_t count);

    /// Bit i: residual i has a bit of `mask`. `count` at most 64.
    std::uint64_t (*nonzero)(const std::uint32_t* residuals, std::size_t count, std::uint32_t mask);
    /// Roughly how many bits `count` residuals cost: 1 for every power of two that a byte's magnitude reaches, and 3
    /// for a pixel that is not zero. Only bytes of `mask` count.
    std::uint32_t (*cost)(const std::uint32_t* residuals, std::size_t count, std::uint32_t mask);
    /// Whether all pixels of the row are `pixel` in the bits of `mask`.
    bool (*all_equal)(const std::byte* row, std::size_t count, std::uint32_t pixel, std::uint32_t mask);
};

/// The fastest that this processor runs.
const RowKernels& row_kernels();
/// All that this processor runs, the plain C++ one first.
std::span<const RowKernels* const> all_row_kernels();

// The SIMD builds among them: row_kernels.inl compiled with 16-byte vectors (SSE2 on x86-64) and with AVX2.
const RowKernels& base_row_kernels();
#if WALL_HAS_AVX2_KERNELS
const RowKernels& avx2_row_kernels();  ///< only where the processor has AVX2
#endif

}  // namespace wall::codec
