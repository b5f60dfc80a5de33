// SPDX-License-Identifier: MIT
#include "common/codec/codec.h"
#include "common/codec/loaded_codecs.h"

namespace wall::codec {

#define WALL_CODEC(name) extern const Codec codec_##name;
#include "common/codec/codec_list.h"
#undef WALL_CODEC

std::span<const Codec* const> codecs() {
    static constexpr const Codec* kCodecs[] = {
#define WALL_CODEC(name) &codec_##name,
#include "common/codec/codec_list.h"
#undef WALL_CODEC
    };
    return kCodecs;
}

Result<const Codec*> find_codec(std::string_view name) {
    for (const Codec* codec : codecs())
        if (codec->name == name) return codec;
    auto loaded = find_loaded_codec(name);
    if (loaded) return loaded;
    std::string names;
    for (const Codec* codec : codecs()) names += (names.empty() ? "" : ", ") + std::string(codec->name);
    return fail("unknown codec '" + std::string(name.substr(0, 64)) + "'; there are: " + names + " (" +
                loaded.error().message + ")");
}

Result<std::unique_ptr<Encoder>> make_encoder(std::string_view codec, const StreamFormat& format,
                                              ParallelFor parallel) {
    if (auto good = check(format); !good) return tl::unexpected(good.error());
    const auto found = find_codec(codec);
    if (!found) return tl::unexpected(found.error());
    return (*found)->make_encoder(format, std::move(parallel));
}

Result<std::unique_ptr<Decoder>> make_decoder(std::string_view codec, const StreamFormat& format,
                                              std::span<const std::byte> header, ParallelFor parallel) {
    if (auto good = check(format); !good) return tl::unexpected(good.error());
    const auto found = find_codec(codec);
    if (!found) return tl::unexpected(found.error());
    return (*found)->make_decoder(format, header, std::move(parallel));
}

}  // namespace wall::codec
