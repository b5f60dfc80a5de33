// SPDX-License-Identifier: MIT
// The shaders of output_pass.cpp, and what they read. docs/walls.md has the formulas; geom::place_in_tile() is the
// specification of the places. Each output gets a program of just the steps that it needs.
#pragma once

#include <array>
#include <cstdint>

namespace wall::tileserver {

/// As the block of the shader lays it out (std140).
struct OutputParameters {
    std::array<std::int32_t, 4> sizes{};   ///< canvas width, height, output width, height
    std::array<std::int32_t, 4> curves{};  ///< points of red, green, blue
    std::array<float, 12> homography{};    ///< rows, the fourth of each unused
    std::array<float, 4> ramps{};          ///< left, right, top, bottom
    std::array<float, 4> blend{};          ///< gamma, black
    std::array<float, 12> color{};         ///< rows; the fourth of the first is gamma
};
static_assert(sizeof(OutputParameters) == 32 + 48 + 16 + 16 + 48);

/// One triangle over all of the picture.
inline constexpr const char* kOutputVertexShader = R"(#version 430
void main() { gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID & 2) - 1, 0, 1); }
)";

/// Behind "#version 430" and #defines: LITTLE (of a pixel), TURNS (by 90 degrees), and where the step is wanted EXACT
/// or ENLARGED, MESH or HOMOGRAPHY, COLOR, BLEND (with LIFT of black), SHARE, RAISE, CURVE. SHARE and RAISE are 2 for a
/// map of as many places as the output has pixels. STEREO, of two eyes, with SIDES, HALVES, ROWS or ANAGLYPH.
inline constexpr const char* kOutputFragmentShader = R"(
layout(binding = 0) uniform sampler2D canvas;  // linear, but for EXACT
layout(binding = 1) uniform sampler2D mesh;    // a point each
layout(binding = 2) uniform sampler2D curves;  // rows of red, green, blue
layout(binding = 3) uniform sampler2D share;   // of light, over all of the output
layout(binding = 4) uniform sampler2D raise;
layout(binding = 5) uniform sampler2D right;   // the right eye's canvas
layout(std140, binding = 0) uniform Parameters {
    ivec4 sizes, points;
    vec4 homography[3], ramps, blend, color[3];
};
layout(location = 0) out vec4 shown;
const int kMostTaps = 8;  // along a side of a pixel

vec2 warped(vec2 at) {
#if defined HOMOGRAPHY
    vec3 p = vec3(at, 1);
    return vec2(dot(homography[0].xyz, p), dot(homography[1].xyz, p)) / dot(homography[2].xyz, p);
#elif defined MESH
    ivec2 size = textureSize(mesh, 0);
    vec2 along = at * vec2(size - 1);
    vec2 first = clamp(floor(along), vec2(0), vec2(size - 2)), t = along - first;
    ivec2 c = ivec2(first);
    return mix(mix(texelFetch(mesh, c, 0).xy, texelFetch(mesh, c + ivec2(1, 0), 0).xy, t.x),
               mix(texelFetch(mesh, c + ivec2(0, 1), 0).xy, texelFetch(mesh, c + ivec2(1, 1), 0).xy, t.x), t.y);
#else
    return at;
#endif
}

// From pixels of the output to pixels of the canvas.
vec2 place(vec2 pixel) {
    vec2 at = warped(pixel / vec2(sizes.zw));
#if TURNS == 1
    at = vec2(1 - at.y, at.x);
#elif TURNS == 2
    at = 1 - at;
#elif TURNS == 3
    at = vec2(at.y, 1 - at.x);
#endif
    return at * vec2(sizes.xy);
}

// Linear between the centres of pixels; black beyond the canvas.
vec3 tap(sampler2D picture, vec2 at) {
    vec2 size = vec2(sizes.xy);
    bool inside = all(greaterThanEqual(at, vec2(0))) && all(lessThanEqual(at, size));
    return inside ? textureLod(picture, at / size, 0).rgb : vec3(0);
}

// As many taps, evenly over the pixel, as it covers pixels of the canvas.
vec3 filtered(sampler2D picture, vec2 at) {
    vec2 across = dFdx(at), down = dFdy(at);
    if (any(isnan(across)) || any(isnan(down))) across = down = vec2(0);  // at the border of what is shown
    vec2 covered = vec2(max(abs(across.x), abs(across.y)), max(abs(down.x), abs(down.y)));
    ivec2 taps = clamp(ivec2(ceil(covered - LITTLE)), 1, kMostTaps);
    vec3 sum = vec3(0);
    for (int y = 0; y < taps.y; ++y)
        for (int x = 0; x < taps.x; ++x) {
            vec2 aside = (vec2(x, y) + 0.5) / vec2(taps) - 0.5;
            sum += tap(picture, at + across * aside.x + down * aside.y);
        }
    return sum / float(taps.x * taps.y);
}

float ramp(float pixels, float width) {
    float t = clamp(pixels / width, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

vec3 blended(vec3 value, vec2 at) {
    vec4 inside = vec4(at.x, float(sizes.x) - at.x, at.y, float(sizes.y) - at.y);
    float weight = 1;
    vec2 projectors = vec2(1), most = vec2(1);  // that show this, along each axis
    for (int edge = 0; edge < 4; ++edge) {
        if (ramps[edge] == 0) continue;
        weight *= ramp(inside[edge], ramps[edge]);
        most[edge / 2] = 2;
        if (inside[edge] < ramps[edge]) projectors[edge / 2] = 2;
    }
#ifndef LIFT
    return value * pow(weight, 1 / blend.x);
#endif
    float lift = (most.x * most.y - projectors.x * projectors.y) * blend.y;
    vec3 light = pow(value, vec3(blend.x)) * weight * (1 - lift) + lift * weight;
    return pow(light, vec3(1 / blend.x));
}

vec3 corrected(vec3 value) {
    float gamma = color[0].w;
    vec3 light = pow(value, vec3(gamma));
    light = vec3(dot(color[0].xyz, light), dot(color[1].xyz, light), dot(color[2].xyz, light));
    return pow(clamp(light, 0.0, 1.0), vec3(1 / gamma));
}

float curve(float value, int row, int count) {
    if (count == 0) return value;
    float along = value * float(count - 1), first = clamp(floor(along), 0.0, float(count - 2));
    int i = int(first);
    return mix(texelFetch(curves, ivec2(i, row), 0).r, texelFetch(curves, ivec2(i + 1, row), 0).r, along - first);
}

// Of a map of `light`, linear between the middles of its places: by hand, because drivers know only some 256 steps.
vec3 between(sampler2D light) {
    ivec2 size = textureSize(light, 0);
    vec2 along = gl_FragCoord.xy / vec2(sizes.zw) * vec2(size) - 0.5, first = floor(along), t = along - first;
    ivec2 a = clamp(ivec2(first), ivec2(0), size - 1), b = clamp(ivec2(first) + 1, ivec2(0), size - 1);
    return mix(mix(texelFetch(light, a, 0).rgb, texelFetch(light, ivec2(b.x, a.y), 0).rgb, t.x),
               mix(texelFetch(light, ivec2(a.x, b.y), 0).rgb, texelFetch(light, b, 0).rgb, t.x), t.y);
}
vec3 pixel_of(sampler2D light) { return texelFetch(light, ivec2(gl_FragCoord.xy), 0).rgb; }

// As far as it is to be filtered, from where the eye sees a pixel of the output.
vec3 seen(sampler2D picture, vec2 at) {
#if defined EXACT
    return texelFetch(picture, ivec2(at), 0).rgb;
#elif defined ENLARGED
    return tap(picture, at);
#else
    return filtered(picture, at);
#endif
}

void main() {
    vec2 pixel = gl_FragCoord.xy;
    bool to_right = false;
#if defined SIDES
    float half_of_it = float(sizes.z) / 2;
    to_right = pixel.x >= half_of_it;
    pixel.x = 2 * (to_right ? pixel.x - half_of_it : pixel.x);
#elif defined HALVES
    float half_of_it = float(sizes.w) / 2;
    to_right = pixel.y >= half_of_it;
    pixel.y = 2 * (to_right ? pixel.y - half_of_it : pixel.y);
#elif defined ROWS
    to_right = (int(pixel.y) & 1) == 1;
#endif
    vec2 at = place(pixel);
    vec3 value = seen(canvas, at);
#ifdef STEREO
    vec3 of_right = seen(right, at);
#ifdef ANAGLYPH
    value.gb = of_right.gb;
#else
    if (to_right) value = of_right;
#endif
#endif
#ifdef COLOR
    value = corrected(value);
#endif
#ifdef BLEND
    value = blended(value, at);
#endif
#if SHARE == 2
    value *= pixel_of(share);
#elif SHARE == 1
    value *= between(share);
#endif
#if RAISE == 2
    vec3 least = pixel_of(raise);
#elif RAISE == 1
    vec3 least = between(raise);
#endif
#if RAISE != 0
    value = value * (1 - least) + least;
#endif
#ifdef CURVE
    value = vec3(curve(value.r, 0, points.x), curve(value.g, 1, points.y), curve(value.b, 2, points.z));
#endif
    shown = vec4(value, 1);
}
)";

}  // namespace wall::tileserver
