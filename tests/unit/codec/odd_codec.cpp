// SPDX-License-Identifier: MIT
// Shared objects that are no good codecs, each in its own way (ODD_KIND).
#include <string.h>

#include "common/codec/wallgl_codec.h"

namespace {

enum Kind { fails, lies, overruns, of_another_version, of_another_name, incomplete };

size_t bound(size_t bytes) { return bytes + 1; }

size_t compress(const void* from, size_t bytes, void* to, size_t room) {
    if (ODD_KIND == fails) return 0;
    memcpy(to, from, bytes);
    if (ODD_KIND == overruns) static_cast<char*>(to)[room] = 0;
    return ODD_KIND == lies ? room + 1 : bytes;
}

int restore(const void* packet, size_t bytes, void* to, size_t wanted) {
    if (ODD_KIND == fails || bytes < wanted) return 0;
    memcpy(to, packet, wanted);
    if (ODD_KIND == overruns) static_cast<char*>(to)[wanted] = 0;
    return 1;
}

constexpr struct wallgl_codec_functions kOdd = {
    ODD_KIND == of_another_version ? WALLGL_CODEC_ABI + 1 : WALLGL_CODEC_ABI,
    ODD_KIND == of_another_name ? "other" : ODD_NAME,
    nullptr,
    bound,
    ODD_KIND == incomplete ? nullptr : compress,
    restore,
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const struct wallgl_codec_functions* wallgl_codec(void) {
    return &kOdd;
}
