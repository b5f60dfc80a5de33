// SPDX-License-Identifier: MIT
// The SIMD builds of the row kernels: row_kernels.inl compiled with 16-byte vectors (SSE2 on x86-64) and with AVX2.
#pragma once

#include "common/codec/row_kernels.h"

namespace wall::codec {

const RowKernels& base_row_kernels();
#if WALL_HAS_AVX2_KERNELS
const RowKernels& avx2_row_kernels();  ///< only where the processor has AVX2
#endif

}  // namespace wall::codec
