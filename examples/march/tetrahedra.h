// SPDX-License-Identifier: MIT
// Marching tetrahedra: the field's surface as triangles, for some layers of a grid of cells. A triangle's corner lies
// on an edge of the grid and is computed from the two ends of that edge only, always in the same order; so processes
// that work on neighbouring layers get the corners between them equal to the last bit, and the surface has no seam.
#pragma once

#include <vector>

#include "examples/field.h"

namespace march {

using example::Field;
using example::Vec3;

struct Corner {
    Vec3 position, normal;
};

class Tetrahedra {
public:
    /// `cells` along each side of the cube from -1 to 1.
    explicit Tetrahedra(int cells) : cells_(cells) {}

    /// Triangles of the layers first <= z < last, three corners each, counter-clockwise seen from outside.
    const std::vector<Corner>& march(const Field& field, int first, int last);

private:
    struct Point {
        Vec3 position;
        float value = 0;
    };
    void sample(const Field& field, int z, std::vector<Point>& layer) const;
    void cell(const Field& field, int x, int y, const std::vector<Point>& below, const std::vector<Point>& above);
    void tetrahedron(const Field& field, const Point& a, const Point& b, const Point& c, const Point& d);
    void triangle(const Field& field, const Vec3& a, const Vec3& b, const Vec3& c);

    int cells_;
    std::vector<Corner> corners_;
};

}  // namespace march
