// SPDX-License-Identifier: MIT
// Compiled with -mavx2. It must not share inline functions with other files: the linker might keep these builds of
// them.
#define WALL_VECTOR_BYTES 32
#define WALL_KERNELS avx2_row_kernels
#define WALL_KERNELS_NAME "avx2"
#include "common/codec/row_kernels.inl"
