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
// A batch may be `coded` (history_coder.h): then its payload is bytes:u32, how many come out, and what the encoder made
// of them. All coded batches of a stream are one sequence, which others stand between.
//
// What several nodes get alike, such as a texture, may go to one of them as a parcel, which hands it on to the next
// one; in the streams of the others an `awaited` frame stands where its commands belong (parcel.h).
//
// The first frame of a client is `hello`; a node answers `welcome`, `ring` or `error` and closes. After `ring` the
// client's frames go through the ring (ring.h) whose descriptor came with the hello's first bytes, and each byte that
// it sends says that there is something in the ring.
//
// After a `welcome` with a number the stream outlives its connection. Both sides count what has come whole of `batch`,
// `coded`, `part`, `parcel` and `awaited` frames, or of `reply` and `swap_done` frames, say now and then how many
// (`receipt`), and keep what they have sent beyond that. A client that has lost the connection comes on another one
// with a hello that names the stream and its count; the node answers `resumed` with its own; and each side sends again
// what the other one has not got. (docs/stream-format.md)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "common/base/ids.h"

namespace wall::wire {

enum class FrameKind : std::uint8_t {
    // client -> node
    hello = 1,  ///< Protobuf DataHello
    batch = 2,  ///< BatchHeader, opcodes, operands (pack_buffer.h)
    part = 3,   ///< of a batch's payload; the next frame goes on with it
    // both ways, not between the parts of a batch
    receipt = 4,  ///< frames:u64 that have come, from the stream's beginning on
    // client -> node
    coded = 5,    ///< a whole batch, coded
    parcel = 7,   ///< a piece of a batch that several nodes get alike, one from the other (parcel.h); node -> node, too
    awaited = 8,  ///< number:u32 from:u32: here comes the parcel that this node hands on
    // node -> node
    partial = 6,  ///< of a window, for one layer (tileserver/partials/partial_format.h)
    // node -> client
    welcome = 16,        ///< stream:u32, by which a later hello names it; 0: it ends with its connection
    reply = 17,          ///< request:u32, then the answer's bytes
    swap_done = 18,      ///< surface:u32 frame:u32: this node has rendered (not necessarily shown) the frame
    error = 19,          ///< UTF-8 text; the node closes the stream after it
    ring = 20,           ///< empty; `welcome`, and what follows is expected in the ring
    room = 21,           ///< empty; there is room in the ring again
    resumed = 22,        ///< frames:u64 as in `receipt`; the stream goes on here
    unreachable = 23,    ///< UTF-8 text, by whoever stands for a node: it cannot be reached now
    begin_again = 24,    ///< empty, by a node that records: what it has is to be told anew from the next frame on
    not_handed_on = 25,  ///< to:u32: that node may not have got what this one was to hand on
    handed_on = 26,      ///< number:u32, by the last of its route: all have got this parcel
};

/// Of those that receipts count.
constexpr bool brings_commands(FrameKind kind) {
    return kind == FrameKind::batch || kind == FrameKind::part || kind == FrameKind::coded ||
           kind == FrameKind::parcel || kind == FrameKind::awaited;
}

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

inline std::vector<std::byte> whole_frame(FrameKind kind, std::span<const std::byte> payload) {
    const auto header = encode_frame_header({static_cast<std::uint32_t>(payload.size()), kind});
    std::vector<std::byte> out(header.begin(), header.end());
    out.insert(out.end(), payload.begin(), payload.end());
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
