// SPDX-License-Identifier: MIT
// Whether a window is seen through the views of the tiles that it covers (docs/walls.md, "Views", "Stereo"), which a
// program can be whose vertices go through a camera that is known: frame after frame those are counted that do, and
// those of which nobody knows. What is drawn without a perspective (a title over the scene) tells nothing. The
// session's mutex guards it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "client_lib/follow/middle_distance.h"
#include "common/glstate/projection.h"
#include "common/glstate/view_change.h"

namespace wall::client {

class ViewUse {
public:
    std::vector<geom::EyeView> offered;  ///< of the tiles that it covers and that look elsewhere, or with one eye
    bool used = false;                   ///< they show what is there; else their parts of the program's picture
    MiddleDistance distance;             ///< of what is drawn

    /// Something is drawn by a projection, in a box where one is known.
    void note(const glstate::Projection& projection, const geom::Box* box) {
        if (projection.camera == glstate::Mat4{}) {
            ++unknown_;
            return;
        }
        if (std::exchange(camera_, projection.camera) != projection.camera)
            perspective_ = glstate::view_change(geom::EyeView{}, camera_).has_value();
        ++(perspective_ ? seen_ : parallel_);
        if (perspective_ && box != nullptr) distance.note(projection.clip_from_object, *box);
    }
    /// A frame is over. True: from the next one on it is seen otherwise.
    bool finish_frame() {
        const unsigned seen = std::exchange(seen_, 0), unknown = std::exchange(unknown_, 0),
                       parallel = std::exchange(parallel_, 0);
        const bool farther = distance.finish_frame();
        const bool now = seen > 0 && seen >= unknown;
        flat_frames_ = now || offered.empty() ? 0 : flat_frames_ + (unknown + parallel > 0 ? 1 : 0);
        if (!wanted() || seen + unknown == 0) return false;
        return std::exchange(used, now) != now || (farther && measures_);
    }
    /// So many frames in a row had no camera that it is no picture of a program that loads.
    bool stays_flat() const { return flat_frames_ >= kManyFlatFrames; }
    /// The distance of what is drawn counts.
    void measure(bool on) { measures_ = on; }
    /// Somebody wants to know what note() is told.
    bool wanted() const { return measures_ || !offered.empty(); }

private:
    static constexpr unsigned kManyFlatFrames = 10;
    unsigned seen_ = 0, unknown_ = 0, parallel_ = 0;  ///< draws of the frame; parallel: without a perspective
    unsigned flat_frames_ = 0;
    glstate::Mat4 camera_{};  ///< of the last of them
    bool perspective_ = false, measures_ = false;
};

}  // namespace wall::client
