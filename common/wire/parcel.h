// SPDX-License-Identifier: MIT
// What several nodes get alike goes to one of them as a parcel, which hands it on to the next one of its route, piece
// by piece while it comes (docs/hand-on.md). A parcel is a whole batch. In the stream of each node but the first an
// `awaited` frame stands where it belongs.
//
//   parcel  := piece*                                     (in order, each the payload of a `parcel` frame)
//   piece   := number:u32 bytes:u32 plain_bytes:u32 offset:u32 position:u32 nodes:u32 node:u32[nodes] content
//   awaited := number:u32 from:u32
//
// number: grows from one parcel of a process to the next. bytes: of all contents together. plain_bytes: of the batch
// that they are made of by a history coder without history (history_coder.h); 0: they are the batch as it is. offset:
// of this content among them. node: the route; position: of who gets the piece. Pure; foreign bytes are checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/ids.h"
#include "common/base/raw_bytes.h"
#include "common/base/result.h"

namespace wall::wire {

inline constexpr std::size_t kParcelPiece = std::size_t{256} << 10;  ///< bytes of a piece that a sender takes
inline constexpr std::uint32_t kMostParcel = 256u << 20;             ///< bytes, of a whole one
inline constexpr std::size_t kMostHandedTo = 64;                     ///< nodes of a route

struct ParcelLead {
    std::uint32_t number = 0, bytes = 0, plain_bytes = 0, offset = 0;
    std::size_t position = 0;      ///< in `route`
    std::vector<NodeIndex> route;  ///< at least one
    std::optional<NodeIndex> next() const {
        return position + 1 < route.size() ? std::optional(route[position + 1]) : std::nullopt;
    }
};

struct ParcelPiece {
    ParcelLead lead;
    std::span<const std::byte> content;
};

/// What stands in front of a piece's content.
std::vector<std::byte> encode_parcel_lead(const ParcelLead& lead);
/// `payload`, which the content stays in, may be foreign.
Result<ParcelPiece> read_parcel_piece(std::span<const std::byte> payload);
/// The same piece for the next one of its route. `payload`: that read_parcel_piece() has taken.
void hand_on_piece(std::span<std::byte> payload);

struct AwaitedParcel {
    std::uint32_t number = 0;
    NodeIndex from;
};
Result<AwaitedParcel> read_awaited(std::span<const std::byte> payload);

/// Puts the pieces of parcels together that come one behind the other.
class ParcelReader {
public:
    /// The whole batch with its last piece. A parcel whose rest does not come, as who handed it on is gone, makes way
    /// for the next one. After an error nothing of the parcel is kept.
    Result<std::optional<RawBytes>> take(const ParcelPiece& piece);

private:
    Result<std::optional<RawBytes>> add(const ParcelPiece& piece);

    std::uint32_t number_ = 0;
    RawBytes bytes_;
};

}  // namespace wall::wire
