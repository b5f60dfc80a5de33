// SPDX-License-Identifier: MIT
#include "tests/unit/tileserver/scene.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace wall::tileserver::test {
namespace {

void triangles(const Gl& gl) {
    gl.Enable(GL_DEPTH_TEST);
    gl.Begin(GL_TRIANGLES);
    for (int i = 0; i < 60; ++i) {
        const float a = static_cast<float>(i) * 0.37f, r = 0.3f + 0.01f * static_cast<float>(i);
        gl.Color3f(0.5f + 0.5f * std::cos(a), 0.5f + 0.5f * std::sin(a), static_cast<float>(i) / 60);
        gl.Vertex3f(r * std::cos(a), r * std::sin(a), std::cos(a * 3) * 0.5f);
        gl.Color3f(0.1f, 0.9f, 0.3f);
        gl.Vertex3f(r * std::cos(a + 0.5f), r * std::sin(a + 0.5f), 0.3f);
        gl.Vertex3f(0.1f * std::cos(a), 0.2f, -0.4f);
    }
    gl.End();
    gl.Disable(GL_DEPTH_TEST);
}

void lines_and_points(const Gl& gl) {
    for (float width : {1.0f, 2.5f}) {
        gl.LineWidth(width);
        gl.PointSize(width * 2);
        gl.Begin(GL_LINE_STRIP);
        for (int i = 0; i < 40; ++i)
            gl.Vertex2f(-0.95f + 0.0487f * static_cast<float>(i), 0.8f * std::sin(static_cast<float>(i) * width));
        gl.End();
        gl.Begin(GL_POINTS);
        for (int i = 0; i < 40; ++i)
            gl.Vertex2f(-0.93f + 0.0471f * static_cast<float>(i), 0.9f * std::cos(static_cast<float>(i) * width));
        gl.End();
    }
    gl.Enable(GL_LINE_STIPPLE);
    gl.LineStipple(2, 0xf3c5);
    gl.Begin(GL_LINE_LOOP);
    for (int i = 0; i < 7; ++i)
        gl.Vertex2f(0.7f * std::cos(static_cast<float>(i)), 0.7f * std::sin(static_cast<float>(i)));
    gl.End();
    gl.Disable(GL_LINE_STIPPLE);
    gl.Enable(GL_LINE_SMOOTH);
    gl.Enable(GL_BLEND);
    gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl.Begin(GL_LINES);
    gl.Vertex2f(-0.9f, -0.77f);
    gl.Vertex2f(0.83f, 0.91f);
    gl.End();
    gl.Disable(GL_LINE_SMOOTH);
    gl.Disable(GL_BLEND);
}

void polygon_stipple(const Gl& gl) {
    std::array<GLubyte, 128> pattern{};
    for (std::size_t i = 0; i < pattern.size(); ++i) pattern[i] = static_cast<GLubyte>(i * 37 + (i >> 3));
    gl.PolygonStipple(pattern.data());
    gl.Enable(GL_POLYGON_STIPPLE);
    gl.Color3f(1, 1, 0.2f);
    gl.Rectf(-0.6f, -0.9f, 0.55f, -0.35f);
    gl.Disable(GL_POLYGON_STIPPLE);
}

void images(const Gl& gl, int width, int height) {
    std::vector<GLubyte> image(64 * 48 * 3);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<GLubyte>(i * 7 + i / 64);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.WindowPos3f(static_cast<float>(width) / 3, static_cast<float>(height) / 4, 0.2f);
    gl.DrawPixels(64, 48, GL_RGB, GL_UNSIGNED_BYTE, image.data());
    gl.PixelZoom(1.5f, -0.7f);
    gl.WindowPos3f(17.3f, static_cast<float>(height) - 10, 0.2f);
    gl.DrawPixels(64, 48, GL_RGB, GL_UNSIGNED_BYTE, image.data());
    gl.PixelZoom(1, 1);
    gl.Color3f(0.2f, 1, 1);
    gl.WindowPos3f(static_cast<float>(width) / 2, 33.5f, 0);
    for (int i = 0; i < 10; ++i) gl.Bitmap(24, 13, 2.0f, 1.5f, 14.3f, 1.1f, image.data() + i);
}

void textures(const Gl& gl) {
    std::vector<GLubyte> image(32 * 32 * 4);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<GLubyte>((i * i) >> 5);
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexParameteri(GL_TEXTURE_2D, GL_GENERATE_MIPMAP, 1);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 32, 32, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
    gl.Enable(GL_TEXTURE_2D);
    gl.TexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    gl.Color3f(1, 0.8f, 0.9f);
    gl.Begin(GL_QUADS);
    const float at[4][4] = {{-0.9f, 0.3f, 0, 0}, {-0.2f, 0.45f, 9, 0}, {-0.1f, 0.95f, 9, 9}, {-0.85f, 0.8f, 0, 5}};
    for (const auto& v : at) {
        gl.TexCoord2f(v[2], v[3]);
        gl.Vertex3f(v[0], v[1], 0);
    }
    gl.End();
    gl.Disable(GL_TEXTURE_2D);
    gl.DeleteTextures(1, &texture);
}

}  // namespace

void draw_scene(const Gl& gl, int width, int height) {
    gl.ClearColor(0.1f, 0.15f, 0.3f, 0);
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    triangles(gl);
    polygon_stipple(gl);
    textures(gl);
    lines_and_points(gl);
    images(gl, width, height);
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(width / 2 + 3, height / 2 + 5, 41, 27);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    gl.Disable(GL_SCISSOR_TEST);
}

}  // namespace wall::tileserver::test
