// SPDX-License-Identifier: MIT
#include "examples/march/tetrahedra.h"

#include <array>
#include <utility>

namespace march {
namespace {

// A cell's corners are numbered by bits: x, y, z. Six tetrahedra around its diagonal fill it; each has its corners in
// ascending order, and so has every edge: the same one in all cells that share it.
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};

Vec3 mix(const Vec3& a, const Vec3& b, float t) {
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

}  // namespace

const std::vector<Corner>& Tetrahedra::march(const Field& field, int first, int last) {
    corners_.clear();
    std::vector<Point> below, above;
    if (first < last) sample(field, first, above);
    for (int z = first; z < last; ++z) {
        below.swap(above);
        sample(field, z + 1, above);
        for (int y = 0; y < cells_; ++y)
            for (int x = 0; x < cells_; ++x) cell(field, x, y, below, above);
    }
    return corners_;
}

void Tetrahedra::sample(const Field& field, int z, std::vector<Point>& layer) const {
    layer.clear();
    const auto place = [&](int i) { return 2 * static_cast<float>(i) / static_cast<float>(cells_) - 1; };
    for (int y = 0; y <= cells_; ++y)
        for (int x = 0; x <= cells_; ++x) {
            const Vec3 position{place(x), place(y), place(z)};
            layer.push_back({position, field.value(position)});
        }
}

void Tetrahedra::cell(const Field& field, int x, int y, const std::vector<Point>& below,
                      const std::vector<Point>& above) {
    std::array<const Point*, 8> corner{};
    unsigned inside = 0;
    for (unsigned i = 0; i < 8; ++i) {
        const int at = (y + static_cast<int>(i >> 1 & 1)) * (cells_ + 1) + x + static_cast<int>(i & 1);
        corner[i] = &(i & 4 ? above : below)[static_cast<std::size_t>(at)];
        inside += corner[i]->value > 0;
    }
    if (inside == 0 || inside == 8) return;
    for (const auto& t : kTetrahedra) tetrahedron(field, *corner[t[0]], *corner[t[1]], *corner[t[2]], *corner[t[3]]);
}

void Tetrahedra::tetrahedron(const Field& field, const Point& a, const Point& b, const Point& c, const Point& d) {
    const std::array<const Point*, 4> points{&a, &b, &c, &d};
    std::array<Vec3, 4> cuts;  // where the surface cuts edges: three of them, or four around
    std::size_t count = 0;
    const auto cut = [&](std::size_t i, std::size_t j) {
        if (i > j) std::swap(i, j);  // the edge's own order, whichever of its ends is inside
        const float vi = points[i]->value, vj = points[j]->value;
        cuts[count++] = mix(points[i]->position, points[j]->position, vi / (vi - vj));
    };
    std::array<std::size_t, 4> in{}, out{};
    std::size_t ins = 0, outs = 0;
    for (std::size_t i = 0; i < 4; ++i) points[i]->value > 0 ? in[ins++] = i : out[outs++] = i;
    if (ins == 2) {
        for (const auto& [i, o] : {std::pair{0, 0}, {0, 1}, {1, 1}, {1, 0}})
            cut(in[static_cast<std::size_t>(i)], out[static_cast<std::size_t>(o)]);
        triangle(field, cuts[0], cuts[1], cuts[2]);
        triangle(field, cuts[0], cuts[2], cuts[3]);
    } else if (ins == 1 || ins == 3) {
        for (std::size_t i = 0; i < 3; ++i) ins == 1 ? cut(in[0], out[i]) : cut(in[i], out[0]);
        triangle(field, cuts[0], cuts[1], cuts[2]);
    }
}

void Tetrahedra::triangle(const Field& field, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Corner first{a, field.normal(a)};
    Corner second{b, field.normal(b)}, third{c, field.normal(c)};
    const Vec3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
    const Vec3 face{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    const float outwards = face.x * first.normal.x + face.y * first.normal.y + face.z * first.normal.z;
    if (outwards < 0) std::swap(second, third);
    corners_.insert(corners_.end(), {first, second, third});
}

}  // namespace march
