// SPDX-License-Identifier: MIT
// Every codec's decoder, and AVI files:
//
//   input  := which:u8  width:u8  height:u8  layout:u8  rest
//   rest   := header_bytes:u8  header  packet*      (which names a codec; packet := bytes:u16 data)
//          |  an AVI file                           (which is beyond the codecs)
#include <algorithm>
#include <sstream>

#include "common/base/assert.h"
#include "common/codec/avi.h"
#include "common/codec/codec.h"
#include "common/codec/huffyuv.h"

namespace {

using namespace wall::codec;
using Bytes = std::span<const std::byte>;

Bytes take(Bytes& from, std::size_t bytes) {
    const Bytes out = from.first(std::min(bytes, from.size()));
    from = from.subspan(out.size());
    return out;
}

/// Reads every byte of the picture, so that the sanitizers see those that nobody wrote.
void look_at(const FrameView& view) {
    unsigned sum = 0;
    for (std::uint32_t y = 0; y < view.height; ++y)
        for (std::size_t i = 0; i < view.row_bytes(); ++i) sum += std::to_integer<unsigned>(view.row(y)[i]);
    WALL_ASSERT(sum <= 255u * view.row_bytes() * view.height);
}

void decode_packets(const Codec& codec, const StreamFormat& format, Bytes rest) {
    const auto header_bytes = take(rest, 1);
    const auto header = take(rest, header_bytes.empty() ? 0 : std::to_integer<std::size_t>(header_bytes[0]) * 4);
    const auto decoder = make_decoder(codec.name, format, header);
    if (!decoder) return;
    while (rest.size() >= 2) {
        const auto size = take(rest, 2);
        const auto view = (*decoder)->decode(
            take(rest, std::to_integer<std::size_t>(size[0]) | std::to_integer<std::size_t>(size[1]) << 8));
        if (view) look_at(*view);
        WALL_ASSERT(view || !view.error().message.empty());
    }
}

void read_avi(Bytes file) {
    auto reader = AviReader::open(
        std::make_unique<std::istringstream>(std::string(reinterpret_cast<const char*>(file.data()), file.size())),
        "fuzz.avi");
    if (!reader) return;
    const auto& avi = reader->format();
    if (avi.width * avi.height > 1u << 16) return;  // not what is tested, and slow
    const auto stream = huffyuv::read_stream(avi.bit_count, avi.height, avi.extradata);
    if (!stream) return;
    const StreamFormat format{avi.width, avi.height,
                              stream->pixels == huffyuv::Pixels::yuy2 ? PixelLayout::yuy2 : PixelLayout::bgra};
    const auto decoder = huffyuv::make_stream_decoder(format, *stream);
    for (auto frame = reader->next(); frame && *frame; frame = reader->next())
        if (decoder)
            if (const auto view = (*decoder)->decode(**frame)) look_at(*view);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 4) return 0;
    const auto rest = std::as_bytes(std::span(data, size)).subspan(4);
    if (data[0] >= codecs().size()) {
        read_avi(rest);
        return 0;
    }
    const StreamFormat format{data[1], data[2], static_cast<PixelLayout>(data[3] % 3), data[3] >= 128};
    decode_packets(*codecs()[data[0]], format, rest);
    return 0;
}
