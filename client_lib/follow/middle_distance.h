// SPDX-License-Identifier: MIT
// How far away the middle of a scene is, which is where a stereo picture is to lie in the screen's plane: as much of it
// comes out of the wall as goes behind it then. Depth that is seen goes by 1 / distance, so that is what the mean is
// of, over all draws of a frame. A new scene is taken up, one that moves a little is not: the screen's plane would
// swim. Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "common/geom/box.h"
#include "common/glstate/projection.h"

namespace wall::client {

class MiddleDistance {
public:
    /// Something in this box is drawn. One that the eye is in, as in a sky, tells nothing.
    void note(const glstate::Mat4& clip_from_object, const geom::Box& box) {
        const auto& m = clip_from_object;
        std::array<float, 4> low, high;
        _mm_storeu_ps(low.data(), box.min);
        _mm_storeu_ps(high.data(), box.max);
        double middle = static_cast<double>(m[15]), around = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double w = static_cast<double>(m[4 * axis + 3]);
            middle += w * (static_cast<double>(low[axis]) + static_cast<double>(high[axis])) / 2;
            around += std::abs(w) * (static_cast<double>(high[axis]) - static_cast<double>(low[axis])) / 2;
        }
        if (!(middle > around) || !std::isfinite(middle)) return;
        nearness_ += 1 / middle;
        ++count_;
    }
    /// True: value() is another one.
    bool finish_frame() {
        constexpr double kOther = 1.3;  // times as far, or as near
        const double now = count_ > 0 ? count_ / nearness_ : 0;
        nearness_ = 0;
        count_ = 0;
        if (!(now > 0) || !std::isfinite(now)) return false;
        if (value_ > 0 && std::max(now / value_, value_ / now) < kOther) return false;
        value_ = now;
        return true;
    }
    /// In the program's units; 0: nobody knows yet.
    double value() const { return value_; }

private:
    double nearness_ = 0, value_ = 0;
    unsigned count_ = 0;
};

}  // namespace wall::client
