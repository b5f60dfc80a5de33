// SPDX-License-Identifier: MIT
// Every limit that a decoder of foreign bytes holds against a length before it does arithmetic with it.
#pragma once

#include <cstdint>

namespace wall::wire {

inline constexpr std::uint32_t kProtocolVersion =
    13;  ///< of control; both sides must agree exactly (data: kStreamVersion, wire.gen.h)
inline constexpr std::uint32_t kMaxControlMessage = 64u << 20;  ///< bytes; the largest is the stacking of many windows
inline constexpr std::uint32_t kControlPart = 1u << 20;         ///< bytes of a picture or an answer in one message
inline constexpr std::uint32_t kMaxFramePayload = 256u << 20;   ///< bytes
inline constexpr std::uint32_t kMaxBatchPayload = 1u << 31;     ///< bytes, of all frames that it comes in
inline constexpr std::uint32_t kMaxBlockBytes =
    kMaxBatchPayload - (64u << 20);  ///< of a block or of one command; the rest of its batch has room beside it
inline constexpr std::uint64_t kMostInstancedElements =
    std::uint64_t{1} << 31;  ///< elements of all instances of a draw: nothing can interrupt a driver within one
inline constexpr std::uint64_t kMostInvocations = std::uint64_t{1}
                                                  << 31;      ///< of a compute shader in one dispatch: as for a draw
inline constexpr std::uint32_t kMaxTilesPerNode = 64;         ///< a tile mask is 64 bits
inline constexpr std::uint32_t kOffscreenSlot = 63;           ///< tile slot of a surface that is on no tile
inline constexpr std::uint32_t kPartialSlot = 62;             ///< a block's other slots are layers of other nodes
inline constexpr std::uint32_t kTileSlots = 62;               ///< those below are tiles'
inline constexpr std::uint32_t kMaxSurfaceExtent = 1u << 15;  ///< pixels a side of a surface or a layer
inline constexpr std::uint32_t kMaxMembers = 64;              ///< processes of one parallel program
inline constexpr std::uint32_t kMaxSharedSurfaces =
    256;  ///< surface ids up to this are a parallel program's common windows

}  // namespace wall::wire
