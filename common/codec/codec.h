// SPDX-License-Identifier: MIT
// The registry of frame codecs (A5.4: what a monitor stream is compressed with is a choice, named in the stream).
// A codec is one file that defines a `Codec`, and one line in codec_list.h. docs/codecs.md describes the formats.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "common/codec/frame.h"

namespace wall::codec {

/// Runs body(0) ... body(count - 1), on any threads in any order, and returns when all are done. Empty: here, in order.
using ParallelFor = std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

enum class PacketKind : std::uint8_t {
    key,    ///< decodes without any other packet
    delta,  ///< needs the packet before it
};

/// One stream's encoder. One thread at a time.
class Encoder {
public:
    virtual ~Encoder() = default;

    /// Appends one packet to `out`. `want` is `key` to ask for a key frame (the first one always is); the answer says
    /// what was written. Fails when the frame does not fit the stream; then nothing was written.
    virtual Result<PacketKind> encode(const FrameView& frame, PacketKind want, std::vector<std::byte>& out) = 0;

    /// What the decoder needs before the first packet; may be empty. Chosen by the first encode(), constant from then
    /// on.
    virtual std::span<const std::byte> stream_header() const { return {}; }
};

/// One stream's decoder; trusts no byte of a packet. One thread at a time.
class Decoder {
public:
    virtual ~Decoder() = default;

    /// The packet's picture, which stays until the next call or the decoder's end. After a failure only a key packet
    /// decodes again.
    virtual Result<FrameView> decode(std::span<const std::byte> packet) = 0;
};

struct Compressor;  // packed_codec.h

struct Codec {
    std::string_view name{};     ///< as in the stream
    std::string_view summary{};  ///< one line for a person
    /// Fails for a format that the codec cannot hold. `parallel` is used by encode(), where the codec can.
    std::function<Result<std::unique_ptr<Encoder>>(const StreamFormat& format, ParallelFor parallel)> make_encoder{};
    /// `header`: the encoder's stream_header(). `parallel` is used by decode(), where the codec can.
    std::function<Result<std::unique_ptr<Decoder>>(const StreamFormat& format, std::span<const std::byte> header,
                                                   ParallelFor parallel)>
        make_decoder{};
    const Compressor* compressor = nullptr;  ///< of any bytes, where the codec is no more than that
};

/// All that are built in, in the order of codec_list.h.
std::span<const Codec* const> codecs();
/// The codec of that name, built in or out of a shared object (loaded_codecs.h); the error lists the names that there
/// are.
Result<const Codec*> find_codec(std::string_view name);

Result<std::unique_ptr<Encoder>> make_encoder(std::string_view codec, const StreamFormat& format,
                                              ParallelFor parallel = {});
Result<std::unique_ptr<Decoder>> make_decoder(std::string_view codec, const StreamFormat& format,
                                              std::span<const std::byte> header = {}, ParallelFor parallel = {});

}  // namespace wall::codec
