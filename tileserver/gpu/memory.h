// SPDX-License-Identifier: MIT
// How the C library's allocator treats what the driver frees. Before other threads.
#pragma once

#include <malloc.h>

namespace wall::tileserver {

/// llvmpipe takes some MiB for each scene that it draws and frees them behind it. By default the allocator gives such
/// memory back to the kernel, which clears each page of it anew for the next scene: small triangles with a state of
/// their own each were drawn five times slower for it (bench/switch_bench).
inline void keep_freed_memory() {
    constexpr int kKept = 128 << 20,
                  kLargestKept = 32 << 20;  // bytes; more than the latter the allocator does not take
    mallopt(M_TRIM_THRESHOLD, kKept);
    mallopt(M_MMAP_THRESHOLD, kLargestKept);
}

}  // namespace wall::tileserver
