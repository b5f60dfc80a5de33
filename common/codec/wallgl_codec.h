/* SPDX-License-Identifier: MIT */
/*
 * A codec out of a shared object (docs/codecs.md, "Codecs from elsewhere"). WALLGL_CODECS, a folder, has it as NAME.so;
 * it is then found by its name wherever one is named, and sees bytes, of pictures or of partial pictures. C, or
 * anything that speaks it. All functions must be safe to call from any thread at any time, and keep nothing between two
 * calls.
 */
#ifndef WALLGL_CODEC_H
#define WALLGL_CODEC_H

#include <stddef.h>

#define WALLGL_CODEC_ABI 1

#ifdef __cplusplus
extern "C" {
#endif

struct wallgl_codec_functions {
    unsigned abi;        /* WALLGL_CODEC_ABI */
    const char* name;    /* as its file: a-z, 0-9 and '-', at most 32; at most 4 for partial pictures */
    const char* summary; /* a line for people */

    /* The most that so many bytes can become. */
    size_t (*bound)(size_t bytes);
    /* Writes at most bound(bytes) to `to`; returns how many, or 0: it cannot. */
    size_t (*compress)(const void* from, size_t bytes, void* to, size_t room);
    /* Fills `wanted` bytes at `to`, and writes no other; 0: the packet is none that becomes so many. Packets may come
       from anybody: nothing in them is to be trusted. */
    int (*restore)(const void* packet, size_t bytes, void* to, size_t wanted);
};

/* What the shared object exports. It stays as long as the process. */
const struct wallgl_codec_functions* wallgl_codec(void);

#ifdef __cplusplus
}
#endif

#endif
