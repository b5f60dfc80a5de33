// SPDX-License-Identifier: MIT
// A codec for WallGL in a shared object (common/codec/wallgl_codec.h): "plz4". Pixels are words of four bytes whose
// first ones are alike, whose second ones are alike, and so on; so each of the four goes into a plane of its own, as
// the difference to the one before, and LZ4 finds runs there.
//
//   WALLGL_CODECS=build/release/examples tileserver ...      [[node]] partial_codec = "plz4"
#include <lz4.h>

#include <climits>
#include <cstdint>
#include <vector>

#include "wallgl_codec.h"

namespace {

constexpr std::size_t kPlanes = 4;

/// Bytes behind the last whole word stay where they are.
std::vector<std::uint8_t> to_planes(const std::uint8_t* words, std::size_t bytes) {
    std::vector<std::uint8_t> out(words, words + bytes);
    const std::size_t count = bytes / kPlanes;
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
        std::uint8_t before = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint8_t value = words[i * kPlanes + plane];
            out[plane * count + i] = static_cast<std::uint8_t>(value - before);
            before = value;
        }
    }
    return out;
}

void from_planes(const std::vector<std::uint8_t>& planes, std::uint8_t* words) {
    const std::size_t count = planes.size() / kPlanes;
    for (std::size_t plane = 0; plane < kPlanes; ++plane) {
        std::uint8_t value = 0;
        for (std::size_t i = 0; i < count; ++i)
            words[i * kPlanes + plane] = value = static_cast<std::uint8_t>(value + planes[plane * count + i]);
    }
    for (std::size_t i = count * kPlanes; i < planes.size(); ++i) words[i] = planes[i];
}

std::size_t bound(std::size_t bytes) {
    return bytes <= LZ4_MAX_INPUT_SIZE ? static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes))) : 0;
}

std::size_t compress(const void* from, std::size_t bytes, void* to, std::size_t room) {
    if (bytes > LZ4_MAX_INPUT_SIZE || room > INT_MAX) return 0;
    const auto planes = to_planes(static_cast<const std::uint8_t*>(from), bytes);
    const int written = LZ4_compress_default(reinterpret_cast<const char*>(planes.data()), static_cast<char*>(to),
                                             static_cast<int>(bytes), static_cast<int>(room));
    return written > 0 ? static_cast<std::size_t>(written) : 0;
}

int restore(const void* packet, std::size_t bytes, void* to, std::size_t wanted) {
    if (bytes > INT_MAX || wanted > LZ4_MAX_INPUT_SIZE) return 0;
    std::vector<std::uint8_t> planes(wanted);
    const int got = LZ4_decompress_safe(static_cast<const char*>(packet), reinterpret_cast<char*>(planes.data()),
                                        static_cast<int>(bytes), static_cast<int>(wanted));
    if (got < 0 || static_cast<std::size_t>(got) != wanted) return 0;
    from_planes(planes, static_cast<std::uint8_t*>(to));
    return 1;
}

constexpr struct wallgl_codec_functions kPlz4 = {
    WALLGL_CODEC_ABI, "plz4", "LZ4 over the planes of four-byte pixels", bound, compress, restore,
};

}  // namespace

extern "C" __attribute__((visibility("default"))) const struct wallgl_codec_functions* wallgl_codec(void) {
    return &kPlz4;
}
