// SPDX-License-Identifier: MIT
#define WALL_VECTOR_BYTES 16
#define WALL_KERNELS base_row_kernels
#define WALL_KERNELS_NAME "base"
#include "common/codec/row_kernels.inl"
