// SPDX-License-Identifier: MIT
// The data stream between a client and a node, from the outside in:
//
//   stream  := frame*
//   frame   := payload_bytes:u32  kind:u8  zero:u8[3]  payload          (little endian; kMaxFramePayload bounds it)
//   payload := kind-specific, see FrameKind
//
// A batch that is larger than a frame should be comes in several: its payload is that of all `part` frames before the
// `batch` frame, and of that. No other frame stands between them; kMaxBatchPayload bounds them together.
//
// The first frame of a client is `hello`; a node answers `welcome` or `error` and closes. (docs/stream-format.md)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/base/ids.h"

namespace wall::wire {

enum class FrameKind : std::uint8_t {
    // client -> node
    hello = 1,  ///< Protobuf DataHello
    batch = 2,  ///< BatchHeader, opcodes, operands (pack_buffer.h)
    part = 3,   ///< of a batch's payload; the next frame goes on with it
    // node -> client
    welcome = 16,    ///< empty
    reply = 17,      ///< request:u32, then the answer's bytes
    swap_done = 18,  ///< surface:u32 frame:u32: this node has rendered (not necessarily shown) the frame
    error = 19,      ///< UTF-8 text; the node closes the stream after it
};

struct FrameHeader {
    std::uint32_t payload_bytes = 0;
    FrameKind kind{};
};

inline constexpr std::size_t kFrameHeaderBytes = 8;
inline constexpr std::size_t kPartBytes = std::size_t{64} << 20;  ///< that a sender takes for each `part` frame

inline std::array<std::byte, kFrameHeaderBytes> encode_frame_header(FrameHeader h) {
    std::array<std::byte, kFrameHeaderBytes> out{};
    std::memcpy(out.data(), &h.payload_bytes, 4);
    out[4] = static_cast<std::byte>(h.kind);
    return out;
}

inline FrameHeader decode_frame_header(const std::byte* bytes) {
    FrameHeader h;
    std::memcpy(&h.payload_bytes, bytes, 4);
    h.kind = static_cast<FrameKind>(bytes[4]);
    return h;
}

/// Start of a batch's payload. Then `opcode_bytes` opcode bytes, *last first* (the packer writes them downwards),
/// padded in front to a multiple of 4, then `operand_bytes` of operands in order. All commands run in context
/// `context`.
struct BatchHeader {
    ContextId context;
    std::uint32_t opcode_bytes;
    std::uint32_t operand_bytes;
};

}  // namespace wall::wire
