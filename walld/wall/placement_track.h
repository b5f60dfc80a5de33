// SPDX-License-Identifier: MIT
// Where one surface is wanted, drawn and shown. The wall wants a rectangle (a new layout version); the program adopts
// it between two frames and says with which frame it begins; the wall shows it there once that frame is presented.
// Until then the surface stays where it is, so that a move leaves neither a hole nor a frame in two places. Pure.
//
//   want(rect) -> version      adopt(version, frame)          presented(frame)
//   wanted ------------------> drawn -----------------------> shown
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "common/geom/rect.h"

namespace wall::walld {

class PlacementTrack {
public:
    /// `version`: of `first`, where an earlier walld has counted.
    explicit PlacementTrack(const geom::Rect& first = {}, std::uint32_t version = 1)
        : wanted_(first), drawn_(first), shown_(first), version_(version) {}

    const geom::Rect& wanted() const { return wanted_; }
    const geom::Rect& drawn() const { return drawn_; }  ///< in the frames that come
    const geom::Rect& shown() const { return shown_; }
    std::uint32_t version() const { return version_; }  ///< of wanted()
    bool moving() const { return shown_ != wanted_; }
    /// What is shown was drawn for the version that is wanted.
    bool settled() const { return offered_.empty() && adopted_.empty(); }

    void want(const geom::Rect& rect);
    /// `frame` and later ones are drawn with that version. False if it was never wanted, or is older than another.
    bool adopt(std::uint32_t version, std::uint32_t frame);
    /// All frames up to this one have been presented. True: shown() is another one now.
    bool presented(std::uint32_t frame);

private:
    struct Adopted {
        std::uint32_t frame = 0;  ///< the first one
        geom::Rect rect;
    };
    geom::Rect wanted_, drawn_, shown_;
    std::uint32_t version_;
    std::map<std::uint32_t, geom::Rect> offered_;  ///< by version: not adopted yet
    std::deque<Adopted> adopted_;                  ///< not shown yet
};

}  // namespace wall::walld
