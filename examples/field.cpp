// SPDX-License-Identifier: MIT
#include "examples/field.h"

#include <cmath>
#include <random>

namespace example {
namespace {

constexpr float kSwing = 0.5f;    // how far a ball gets from the middle
constexpr float kRadius = 0.45f;  // of its influence; with kSwing it stays within the cube
constexpr float kLevel = 0.3f;    // of the surface

Vec3 minus(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// 1 in the ball's middle, 0 at its radius; `d2` is the distance's square.
float nearness(float d2) { return 1 - d2 / (kRadius * kRadius); }

}  // namespace

Field::Field(unsigned seed, int balls) {
    std::mt19937 random(seed);
    const auto between = [&](float low, float high) {
        return low + (high - low) * static_cast<float>(random() % 10000) / 10000;
    };
    for (int i = 0; i < balls; ++i) {
        Ball ball;
        for (float* axis : {&ball.speed.x, &ball.speed.y, &ball.speed.z}) *axis = between(0.01f, 0.04f);
        for (float* axis : {&ball.phase.x, &ball.phase.y, &ball.phase.z}) *axis = between(0, 6.28f);
        balls_.push_back(ball);
    }
    move_to(0);
}

void Field::move_to(int frame) {
    const auto time = static_cast<float>(frame);
    for (Ball& ball : balls_)
        ball.now = {kSwing * std::sin(ball.speed.x * time + ball.phase.x),
                    kSwing * std::sin(ball.speed.y * time + ball.phase.y),
                    kSwing * std::sin(ball.speed.z * time + ball.phase.z)};
}

float Field::value(const Vec3& at) const {
    float sum = -kLevel;
    for (const Ball& ball : balls_) {
        const Vec3 d = minus(at, ball.now);
        const float near = nearness(d.x * d.x + d.y * d.y + d.z * d.z);
        if (near > 0) sum += near * near * near;
    }
    return sum;
}

Vec3 Field::normal(const Vec3& at) const {
    Vec3 sum;
    for (const Ball& ball : balls_) {
        const Vec3 d = minus(at, ball.now);
        const float near = nearness(d.x * d.x + d.y * d.y + d.z * d.z);
        if (near <= 0) continue;
        const float slope = near * near;
        sum = {sum.x + slope * d.x, sum.y + slope * d.y, sum.z + slope * d.z};
    }
    const float length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
    return length > 0 ? Vec3{sum.x / length, sum.y / length, sum.z / length} : Vec3{0, 0, 1};
}

}  // namespace example
