// SPDX-License-Identifier: MIT
// A viewer trusts nothing that comes as a stream. Input: (kind:u8 length:u16 bytes)*, kind odd: a frame, else a text.
#include "tools/view/picture_builder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    wall::view::PictureBuilder builder;
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    while (rest.size() >= 3) {
        const bool binary = (rest[0] & 1) != 0;
        const auto length = static_cast<unsigned char>(rest[1]) | std::size_t{static_cast<unsigned char>(rest[2])} << 8;
        rest.remove_prefix(3);
        const auto message = rest.substr(0, length);
        rest.remove_prefix(message.size());
        const auto taken = binary ? builder.take_frame(message) : builder.take_text(message);
        if (!taken && taken.error().message.empty()) __builtin_trap();
    }
    const auto picture = builder.picture().view();
    if (builder.complete() && picture.width == 0) __builtin_trap();
    return 0;
}
