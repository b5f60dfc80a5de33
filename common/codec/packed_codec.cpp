// SPDX-License-Identifier: MIT
#include "common/codec/packed_codec.h"

#include <cstring>

namespace wall::codec {
namespace {

class PackedEncoder final : public Encoder {
public:
    PackedEncoder(const StreamFormat& format, const Compressor& compressor)
        : format_(format), compressor_(compressor), rows_(format), packet_(compressor.bound(rows_.bytes().size())) {}

    Result<PacketKind> encode(const FrameView& frame, PacketKind, std::vector<std::byte>& out) override {
        if (auto good = check(frame, format_); !good) return tl::unexpected(good.error());
        for (std::uint32_t y = 0; y < frame.height; ++y) std::memcpy(rows_.row(y), frame.row(y), frame.row_bytes());
        if (!format_.alpha && format_.layout != PixelLayout::yuy2) set_opaque();
        const auto written = compressor_.compress(rows_.bytes(), packet_);
        if (!written) return tl::unexpected(written.error());
        out.insert(out.end(), packet_.begin(), packet_.begin() + static_cast<std::ptrdiff_t>(*written));
        return PacketKind::key;
    }

private:
    void set_opaque() {
        auto& bytes = rows_.bytes();
        for (std::size_t at = 3; at < bytes.size(); at += 4) bytes[at] = std::byte{255};
    }

    const StreamFormat format_;
    const Compressor& compressor_;
    Picture rows_;
    std::vector<std::byte> packet_;
};

class PackedDecoder final : public Decoder {
public:
    PackedDecoder(const StreamFormat& format, const Compressor& compressor)
        : compressor_(compressor), picture_(format) {}

    Result<FrameView> decode(Bytes packet) override {
        if (auto done = compressor_.restore(packet, picture_.bytes()); !done) return tl::unexpected(done.error());
        return picture_.view();
    }

private:
    const Compressor& compressor_;
    Picture picture_;
};

}  // namespace

Result<std::unique_ptr<Encoder>> make_packed_encoder(const StreamFormat& format, const Compressor& compressor) {
    return std::make_unique<PackedEncoder>(format, compressor);
}

Result<std::unique_ptr<Decoder>> make_packed_decoder(const StreamFormat& format, const Compressor& compressor) {
    return std::make_unique<PackedDecoder>(format, compressor);
}

}  // namespace wall::codec
