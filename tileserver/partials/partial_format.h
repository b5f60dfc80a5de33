// SPDX-License-Identifier: MIT
// What one node sends another one of a sort-last session: the pixels that it has drawn of a window in the area of one
// layer, with their depths (A3.3: colour and depth of each renderer meet where they are composed); without where they
// blend. What was not drawn is not sent: the pixels come as runs.
//
//   partial := surface:u32 sequence:u32 from:u32 slot:u32 x:i32 y:i32 width:u32 height:u32 top_row_first:u32
//              codec:u32 plain_bytes:u32 rank:u32 planes:u32 coded
//   plain   := runs:u32 pixels:u32 (skip:u32 take:u32)[runs] color:u32[pixels] depth:u32[pixels]     (little endian)
//   planes  := 1 (no depths) | 2
//
// A color is RGBA, red in its low byte; a depth has 24 bits in its high ones, and in its low ones what the receiver
// does not look at. A codec is named by four letters, as AnyGL names them in its packets (A5.3). Pure; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/base/ids.h"
#include "common/base/result.h"
#include "common/geom/rect.h"
#include "tileserver/gpu/gl.h"

namespace wall::tileserver {

/// Colours, depths and stencil values of a part of a layer, row by row.
struct PixelBlock {
    geom::Rect area;  ///< window pixels, origin bottom left
    bool top_row_first = false;
    std::vector<std::uint32_t> colors;  ///< RGBA, red in the low byte
    std::vector<std::uint32_t> depths;  ///< 24 bits, then 8 of the stencil (GL_UNSIGNED_INT_24_8)

    std::size_t pixels() const { return static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height); }
};

/// What a partial picture is of.
struct PartialKey {
    SurfaceId surface;
    std::uint32_t sequence = 0;  ///< grows with every composition of the window, by one process
    std::uint32_t rank = 0;      ///< of that, in a parallel program
    NodeIndex from;
    std::uint32_t slot = 0;  ///< of the receiver's layer
    auto operator<=>(const PartialKey&) const = default;
};

/// The codec that leaves all as it is.
inline constexpr std::string_view kNoCodec = "none";
/// Whether partial pictures may be coded by it: that, or a codec of bytes with a name of at most four letters
/// (common/codec). An error says what is expected.
Result<void> check_partial_codec(std::string_view name);

struct PixelRun {
    std::uint32_t skip = 0, take = 0;  ///< pixels
};

/// A partial picture, read.
struct Partial {
    PartialKey key;
    geom::Rect area;
    bool top_row_first = false;
    std::vector<PixelRun> runs;
    std::vector<std::uint32_t> colors, depths;  ///< of the pixels that runs take; there may be no depths
};

inline constexpr std::size_t kPartialHeader = 52;             ///< bytes
inline constexpr std::uint32_t kMaxPartialPixels = 1u << 24;  ///< of a layer that partial pictures are sent for

enum class PartialPlanes : std::uint32_t { colors = 1, colors_and_depths };

/// The pixels whose stencil value is not 0; of a block without values none.
std::vector<std::byte> encode_partial(const PartialKey& key, const PixelBlock& block, std::string_view codec = kNoCodec,
                                      PartialPlanes planes = PartialPlanes::colors_and_depths);
/// The same partial picture by another codec; a message that encode_partial() has made. As it is, if the codec cannot.
std::vector<std::byte> recode_partial(std::span<const std::byte> message, std::string_view codec);
/// Of foreign bytes: only what they say that they are.
Result<PartialKey> key_of_partial(std::span<const std::byte> message);
Result<Partial> decode_partial(std::span<const std::byte> message);

/// What several nodes have drawn, put together by one that has drawn nothing itself: into a block of zeros, whose
/// values tell then what was drawn. Else as merge().
bool compose(const Partial& partial, GLenum by, PixelBlock& into);
/// Whether merge() knows it.
bool is_merge(GLenum by);
/// What was drawn for others, as if it were drawn now. `by`: GL_LESS, GL_LEQUAL, GL_GREATER or GL_GEQUAL, and those
/// pixels whose depth passes the test take the place of what is there; stencil values stay. Or GL_BLEND, and the
/// colours lie over what is there ("over" by Porter and Duff 1984, alpha multiplied into them); depths stay as well.
/// False: they are not of the same area, or have no depths to be tested.
bool merge(const Partial& partial, GLenum by, PixelBlock& into);

}  // namespace wall::tileserver
