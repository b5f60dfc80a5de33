// SPDX-License-Identifier: MIT
// What is drawn: soft balls that move and melt into one another. A function of the seed, the frame and the place only,
// so that every process can compute its part of it without asking the others.
#pragma once

#include <vector>

namespace example {

struct Vec3 {
    float x = 0, y = 0, z = 0;
};

class Field {
public:
    /// Within the cube from -1 to 1; nothing reaches its sides.
    Field(unsigned seed, int balls);

    void move_to(int frame);
    /// Positive inside the surface.
    float value(const Vec3& at) const;
    /// Out of the surface; of length 1.
    Vec3 normal(const Vec3& at) const;

private:
    struct Ball {
        Vec3 speed, phase;  ///< of its swing along each axis: radians a frame, radians
        Vec3 now;
    };
    std::vector<Ball> balls_;
};

}  // namespace example
