// SPDX-License-Identifier: MIT
// The picture of one stream, put together from what walld says (docs/streams.md): parts are decoded and painted where
// they lie; where no tile is, and where a node is away, is the wall's background. Pure; one thread.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "common/codec/codec.h"
#include "common/geom/rect.h"

namespace wall::view {

class PictureBuilder {
public:
    /// A text message. The error is walld's, or says what walld should not have sent.
    Result<void> take_text(std::string_view text);
    /// A binary message.
    Result<void> take_frame(std::string_view frame);

    /// RGBA; of no size before walld has told the parts.
    const codec::Picture& picture() const { return picture_; }
    /// Every tile whose node is up has shown its part, and there is one at all.
    bool complete() const;
    /// Why there is no picture, if so.
    const std::string& ended() const { return ended_; }

private:
    struct Part {
        std::string tile;
        geom::Rect at;
        bool expected = false, shown = false;
        std::unique_ptr<codec::Decoder> decoder;
    };
    Result<void> set_parts(const nlohmann::json& text);
    Result<void> take_part(const nlohmann::json& text, Part& part);
    void paint(const geom::Rect& at, const codec::FrameView& frame);
    void clear(const geom::Rect& at);

    std::string codec_, ended_;
    std::uint32_t background_ = 0;  ///< 0xRRGGBB
    codec::StreamFormat format_;
    codec::Picture picture_;
    std::vector<Part> parts_;
};

}  // namespace wall::view
