// SPDX-License-Identifier: MIT
// Small conversions between walld's types and control.proto. Pure.
#pragma once

#include <optional>

#include "common/geom/rect.h"
#include "common/geom/tile_output.h"
#include "common/geom/view.h"
#include "common/wire/limits.h"
#include "proto/control.pb.h"

namespace wall::walld {

/// make(&proto::Envelope::mutable_present, message): the message in its envelope.
template <class Message>
proto::Envelope make(Message* (proto::Envelope::*field)(), const Message& message) {
    proto::Envelope out;
    *(out.*field)() = message;
    return out;
}

inline proto::Rect to_proto(const geom::Rect& rect) {
    proto::Rect out;
    out.set_x(rect.x);
    out.set_y(rect.y);
    out.set_width(static_cast<std::uint32_t>(rect.width));
    out.set_height(static_cast<std::uint32_t>(rect.height));
    return out;
}

/// Of a tile's output that has something to do.
proto::TileOutput to_proto(const geom::TileOutput& output);
proto::View to_proto(const geom::View& view);
/// Of a program's words; nothing: it cannot be.
std::optional<proto::Stereo> checked(const proto::Stereo& told);

inline geom::Rect from_proto(const proto::Rect& rect) {
    return {rect.x(), rect.y(), static_cast<std::int32_t>(rect.width()), static_cast<std::int32_t>(rect.height())};
}

/// Of a window.
inline bool extent_ok(std::uint32_t width, std::uint32_t height) {
    return width > 0 && height > 0 && width <= wire::kMaxSurfaceExtent && height <= wire::kMaxSurfaceExtent;
}

inline proto::Envelope refused(const std::string& reason) {
    proto::Envelope out;
    out.mutable_refused()->set_reason(reason);
    return out;
}

}  // namespace wall::walld
