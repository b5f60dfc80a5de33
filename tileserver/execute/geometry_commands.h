// SPDX-License-Identifier: MIT
// Group [geometry]: what stands between glBegin and glEnd. Most of a stream: everything that a command needs lies in
// this object. Render thread.
#pragma once

#include <cstdint>
#include <utility>

#include "tileserver/execute/execution.h"

namespace wall::tileserver {

using glstate::Attribute;

class GeometryCommands {
public:
    explicit GeometryCommands(Execution& execution) : gl_(execution.gl), execution_(execution) {}

    /// That the commands write to; the other groups and the executor look at it, and set it up.
    OpenBlock& block() { return block_; }
    /// The block's last Begin, for the driver: now, or again after a pause.
    void begin_drawing() {
        const GLenum mode = block_.begin.mode;
        if (mode > GL_PATCHES || ((block_.drawable >> mode & 1) == 0 && !may_begin())) return;
        gl_.Begin(mode);
        block_.begun = true;
    }
    void end_drawing() {
        if (std::exchange(block_.begun, false)) gl_.End();
    }

    void Begin(GLenum mode) {
        if (block_.in_begin) return execution_.refuse("inside Begin and End");
        block_.in_begin = true;
        block_.begin = {mode, block_.vertices, true};
        if (block_.draws) begin_drawing();
    }
    void End() {
        if (!block_.in_begin) return execution_.refuse("without Begin");
        block_.in_begin = false;
        end_drawing();
    }
    void Vertex2f(float x, float y) {
        ++block_.vertices;
        if (block_.begun) gl_.Vertex2f(x, y);
    }
    void Vertex3f(float x, float y, float z) {
        ++block_.vertices;
        if (block_.begun) gl_.Vertex3f(x, y, z);
    }
    void Vertex4f(float x, float y, float z, float w) {
        ++block_.vertices;
        if (block_.begun) gl_.Vertex4f(x, y, z, w);
    }
    void Normal3f(float x, float y, float z) {
        block_.trail.set(Attribute::normal, x, y, z);
        if (block_.draws) gl_.Normal3f(x, y, z);
    }
    void Color3f(float r, float g, float b) {
        block_.trail.set(Attribute::color, r, g, b);
        if (block_.draws) gl_.Color3f(r, g, b);
    }
    void Color4f(float r, float g, float b, float a) {
        block_.trail.set(Attribute::color, r, g, b, a);
        if (block_.draws) gl_.Color4f(r, g, b, a);
    }
    void Color4ub(std::uint32_t rgba) {
        const auto byte = [rgba](unsigned shift) { return static_cast<float>(rgba >> shift & 0xff) / 255.0f; };
        block_.trail.set(Attribute::color, byte(0), byte(8), byte(16), byte(24));
        if (block_.draws) gl_.Color4ubv(reinterpret_cast<const GLubyte*>(&rgba));
    }
    void SecondaryColor3f(float r, float g, float b) {
        block_.trail.set(Attribute::secondary_color, r, g, b);
        if (block_.draws) gl_.SecondaryColor3f(r, g, b);
    }
    void TexCoord1f(float s) {
        block_.trail.set(Attribute::texcoord, s);
        if (block_.draws) gl_.TexCoord1f(s);
    }
    void TexCoord2f(float s, float t) {
        block_.trail.set(Attribute::texcoord, s, t);
        if (block_.draws) gl_.TexCoord2f(s, t);
    }
    void TexCoord3f(float s, float t, float r) {
        block_.trail.set(Attribute::texcoord, s, t, r);
        if (block_.draws) gl_.TexCoord3f(s, t, r);
    }
    void TexCoord4f(float s, float t, float r, float q) {
        block_.trail.set(Attribute::texcoord, s, t, r, q);
        if (block_.draws) gl_.TexCoord4f(s, t, r, q);
    }
    void MultiTexCoord4f(std::uint32_t unit, float s, float t, float r, float q) {
        if (unit >= glstate::el::texcoord::count) return execution_.refuse("no such texture coordinates");
        block_.trail.set(Attribute::texcoord + unit, s, t, r, q);
        if (block_.draws) gl_.MultiTexCoord4f(GL_TEXTURE0 + unit, s, t, r, q);
    }
    void FogCoordf(float coord) {
        block_.trail.set(Attribute::fog_coord, coord);
        if (block_.draws) gl_.FogCoordf(coord);
    }
    void EdgeFlag(std::uint32_t flag) {
        block_.trail.set(Attribute::edge_flag, flag != 0 ? 1.0f : 0.0f);
        if (block_.draws) gl_.EdgeFlag(flag != 0 ? GL_TRUE : GL_FALSE);
    }
    void Indexf(float c) {
        block_.trail.set(Attribute::color_index, c);
        if (block_.draws) gl_.Indexf(c);
    }
    void VertexAttrib4f(std::uint32_t index, float x, float y, float z, float w) {
        if (index >= glstate::el::vertex_attrib::count) return execution_.refuse("no such attribute");
        if (index != 0) block_.trail.set(Attribute::vertex_attrib + index, x, y, z, w);
        else block_.begin.countable = false;
        if (block_.draws) gl_.VertexAttrib4f(index, x, y, z, w);
    }
    void Material(GLenum face, GLenum pname, float p0, float p1, float p2, float p3);
    void EvalCoord1f(float u) {
        block_.begin.countable = false;
        if (block_.begun) gl_.EvalCoord1f(u);
    }
    void EvalCoord2f(float u, float v) {
        block_.begin.countable = false;
        if (block_.begun) gl_.EvalCoord2f(u, v);
    }
    void EvalPoint1(std::int32_t i) {
        block_.begin.countable = false;
        if (block_.begun) gl_.EvalPoint1(i);
    }
    void EvalPoint2(std::int32_t i, std::int32_t j) {
        block_.begin.countable = false;
        if (block_.begun) gl_.EvalPoint2(i, j);
    }

private:
    bool may_begin();

    const Gl& gl_;
    OpenBlock block_;
    Execution& execution_;
};

}  // namespace wall::tileserver
