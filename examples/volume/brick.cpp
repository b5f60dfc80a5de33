// SPDX-License-Identifier: MIT
#include "examples/volume/brick.h"

#include <GL/glext.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace volume {
namespace {

constexpr float kReach = 1.75f;   // of the cube's corners, and a little more
constexpr float kDensity = 3.5f;  // of the middle of a ball, an opacity for each unit of length
constexpr Vec3 kLight{0.4f, 0.7f, 0.6f};

float dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vec3 between(const Vec3& a, const Vec3& b, float t) {
    return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

GLubyte as_byte(float value) { return static_cast<GLubyte>(std::lround(std::clamp(value, 0.f, 1.f) * 255)); }

}  // namespace

Vec3 turned(const Turn& turn, const Vec3& v) { return {dot(turn[0], v), dot(turn[1], v), dot(turn[2], v)}; }

Vec3 turned_back(const Turn& turn, const Vec3& v) {
    return {turn[0].x * v.x + turn[1].x * v.y + turn[2].x * v.z, turn[0].y * v.x + turn[1].y * v.y + turn[2].y * v.z,
            turn[0].z * v.x + turn[1].z * v.y + turn[2].z * v.z};
}

Brick::Brick(const example::Field& field, int cells, int first, int last, int planes)
    : cells_(cells), first_(first), last_(last), planes_(planes) {
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_3D, texture_);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_3D, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTexParameteri(GL_TEXTURE_3D, wrap, GL_CLAMP_TO_EDGE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, last - first + 1, cells + 1, cells + 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 texels(field).data());
}

Brick::~Brick() { glDeleteTextures(1, &texture_); }

std::vector<GLubyte> Brick::texels(const example::Field& field) const {
    const float step = 2 * kReach / static_cast<float>(planes_);
    std::vector<GLubyte> out;
    for (int z = 0; z <= cells_; ++z)
        for (int y = 0; y <= cells_; ++y)
            for (int x = first_; x <= last_; ++x) {
                const Vec3 at{place(x), place(y), place(z)};
                const float opacity = 1 - std::exp(-kDensity * step * std::max(0.f, field.value(at) + 0.25f));
                const float lit = 0.35f + 0.65f * std::max(0.f, dot(field.normal(at), kLight));
                const Vec3 color{0.95f * lit, (0.55f + 0.4f * at.y) * lit, (0.35f + 0.5f * at.x) * lit};
                for (const float value : {color.x * opacity, color.y * opacity, color.z * opacity, opacity})
                    out.push_back(as_byte(value));
            }
    return out;
}

/// What of the polygon lies there.
void Brick::cut(Polygon& polygon, float Vec3::*axis, float least, float most) const {
    for (const auto& [bound, sign] : {std::pair{least, 1.f}, {most, -1.f}}) {
        Polygon inside;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const float from = sign * (a.*axis - bound), to = sign * (b.*axis - bound);
            if (from >= 0) inside.push_back(a);
            if ((from >= 0) == (to >= 0)) continue;
            inside.push_back(between(a, b, from / (from - to)));
            inside.back().*axis = bound;
        }
        polygon = std::move(inside);
    }
}

void Brick::draw(const Turn& turn) const {
    const auto width = static_cast<float>(last_ - first_ + 1), others = static_cast<float>(cells_ + 1);
    const auto texture_place = [&](float at, int first, float texels) {
        return ((at + 1) / 2 * static_cast<float>(cells_) - static_cast<float>(first) + 0.5f) / texels;
    };
    glBindTexture(GL_TEXTURE_3D, texture_);
    for (int plane = 0; plane < planes_; ++plane) {
        const float z = kReach * (2 * (static_cast<float>(plane) + 0.5f) / static_cast<float>(planes_) - 1);
        Polygon polygon;
        for (const auto& [x, y] : {std::pair{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}})
            polygon.push_back(turned_back(turn, {2 * kReach * x, 2 * kReach * y, z}));
        cut(polygon, &Vec3::x, place(first_), place(last_));
        cut(polygon, &Vec3::y, -1, 1);
        cut(polygon, &Vec3::z, -1, 1);
        if (polygon.size() < 3) continue;
        glBegin(GL_TRIANGLE_FAN);
        for (const Vec3& at : polygon) {
            glTexCoord3f(texture_place(at.x, first_, width), texture_place(at.y, 0, others),
                         texture_place(at.z, 0, others));
            glVertex3fv(&at.x);
        }
        glEnd();
    }
}

std::vector<int> back_to_front(const std::vector<float>& borders, float eye) {
    std::vector<int> order;
    int left = 0, right = static_cast<int>(borders.size()) - 2;
    const auto border = [&](int place) { return borders[static_cast<std::size_t>(place)]; };
    while (left <= right && border(left + 1) <= eye) order.push_back(left++);
    while (right >= left && border(right) >= eye) order.push_back(right--);
    for (; left <= right; ++left) order.push_back(left);  // that the eye is in
    return order;
}

}  // namespace volume
