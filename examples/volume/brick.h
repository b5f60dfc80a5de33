// SPDX-License-Identifier: MIT
// A part of a volume: a slab of the cube from -1 to 1, as a texture of colours and opacities, and the planes that show
// it. Neighbours share the samples between them, so that the volume has no seam.
#pragma once

#include <GL/gl.h>

#include <array>
#include <vector>

#include "examples/field.h"

namespace volume {

using example::Vec3;

/// A turn of the cube before the eye: rows of a rotation.
using Turn = std::array<Vec3, 3>;
Vec3 turned(const Turn& turn, const Vec3& v);
/// The other way.
Vec3 turned_back(const Turn& turn, const Vec3& v);

class Brick {
public:
    /// With a current context: the cells first <= x < last, of `cells` along each side of the cube.
    Brick(const example::Field& field, int cells, int first, int last, int planes);
    ~Brick();
    Brick(const Brick&) = delete;
    Brick& operator=(const Brick&) = delete;

    /// `planes` of the whole cube that are at right angles to the line of sight, the farthest first, as far as they lie
    /// in the brick. The modelview matrix turns the cube so, and moves it along that line.
    void draw(const Turn& turn) const;

private:
    using Polygon = std::vector<Vec3>;
    /// Each texel is what is seen of the volume in one plane, its colour multiplied by its opacity.
    std::vector<GLubyte> texels(const example::Field& field) const;
    float place(int sample) const { return -1 + 2 * static_cast<float>(sample) / static_cast<float>(cells_); }
    void cut(Polygon& polygon, float Vec3::*axis, float least, float most) const;

    int cells_, first_, last_, planes_;
    GLuint texture_ = 0;
};

/// The slabs between these planes of constant x, the farthest from an eye at `eye` first: what lies behind another is
/// drawn before it, wherever the eye is.
std::vector<int> back_to_front(const std::vector<float>& borders, float eye);

}  // namespace volume
