// SPDX-License-Identifier: MIT
// Shaders whose position is recognised give the same as what they say; the others are not recognised, and it is known
// why.
#include "tileserver/objects/position_recogniser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tileserver/objects/position_builder.h"
#include "tileserver/objects/shader_tree.h"

namespace wall::tileserver {
namespace {

using glapi::PositionProgram;
using Mat4 = std::array<float, 16>;
using Vec4 = std::array<float, 4>;

RecognisedPosition recognise(const std::string& source) {
    glapi::ProgramDefinition definition;
    definition.shaders = {{GL_VERTEX_SHADER, true, source}, {GL_FRAGMENT_SHADER, true, "void main() {}"}};
    return recognise_position(definition);
}

// ---- what shaders see ----

/// Values that are no pattern, of any name.
std::vector<float> values_of(const glapi::PositionUniform& uniform, std::size_t count) {
    std::vector<float> out;
    unsigned seed = static_cast<unsigned>(uniform.element) + 7;
    for (const char c : uniform.name) seed = seed * 31 + static_cast<unsigned char>(c);
    for (std::size_t i = 0; i < count; ++i) {
        seed = seed * 1664525 + 1013904223;
        out.push_back(static_cast<float>(seed >> 16) / 32768.0f - 1.0f + (i % 5 == 0 ? 3.0f : 0.0f));
    }
    return out;
}
Mat4 matrix_of(const std::string& name, std::uint32_t element = 0) {
    Mat4 out;
    const auto values = values_of({name, element}, 16);
    std::copy(values.begin(), values.end(), out.begin());
    return out;
}
const Mat4 kModelview = matrix_of("modelview"), kProjection = matrix_of("projection");

Vec4 operator*(const Mat4& m, const Vec4& v) {
    Vec4 out{};
    for (int row = 0; row < 4; ++row)
        for (int i = 0; i < 4; ++i) out[row] += m[4 * i + row] * v[i];
    return out;
}
Mat4 operator*(const Mat4& a, const Mat4& b) {
    Mat4 out{};
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            for (int i = 0; i < 4; ++i) out[4 * column + row] += a[4 * i + row] * b[4 * column + i];
    return out;
}
Mat4 transposed(const Mat4& m) {
    Mat4 out;
    for (int i = 0; i < 16; ++i) out[i % 4 * 4 + i / 4] = m[i];
    return out;
}

std::optional<Mat4> evaluated(const PositionProgram& program) {
    std::vector<std::vector<float>> values(program.uniforms.size());
    for (const auto& step : program.steps)
        if (step.op == glapi::PositionOp::uniform)
            values[step.operands[0]] = values_of(program.uniforms[step.operands[0]], step.components());
    const std::vector<std::span<const float>> spans(values.begin(), values.end());
    const auto transform = evaluate(program, {spans, kModelview, kProjection});
    return transform ? std::optional(transform->matrix()) : std::nullopt;
}

/// `expected` is given (x, y, z, 1).
void same_as(const std::string& source, const std::string& attribute, const std::function<Vec4(Vec4)>& expected) {
    SCOPED_TRACE(source);
    const RecognisedPosition found = recognise(source);
    ASSERT_TRUE(found.program.known()) << found.reason;
    EXPECT_EQ(found.program.attribute, attribute);
    EXPECT_TRUE(is_valid(found.program));
    const auto matrix = evaluated(found.program);
    ASSERT_TRUE(matrix);
    for (const Vec4& vertex : {Vec4{0, 0, 0, 1}, Vec4{1, 0, 0, 1}, Vec4{-2, 3, 0.5f, 1}, Vec4{7, -1, 4, 1}}) {
        const Vec4 is = *matrix * vertex, should = expected(vertex);
        for (int i = 0; i < 4; ++i) {
            if (i == 2 && !found.program.depth) continue;
            EXPECT_NEAR(is[i], should[i], 1e-4f * (1 + std::abs(should[i]))) << i;
        }
    }
}

void not_recognised(const std::string& source, WhyUnknown why) {
    SCOPED_TRACE(source);
    const RecognisedPosition found = recognise(source);
    EXPECT_FALSE(found.program.known());
    EXPECT_EQ(found.reason, describe(why));
}

const Mat4 kMvp = kProjection * kModelview;

// ---- fixed function's matrices ----

TEST(PositionRecogniser, FixedFunction) {
    same_as("void main() { gl_Position = ftransform(); }", "gl_Vertex", [](Vec4 v) { return kMvp * v; });
    same_as("void main() { gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex; gl_FrontColor = gl_Color; }",
            "gl_Vertex", [](Vec4 v) { return kMvp * v; });
    same_as(
        "varying vec3 normal; varying vec3 eye;\n"
        "void main() { vec4 e = gl_ModelViewMatrix * gl_Vertex; eye = normalize(e.xyz);\n"
        "  normal = gl_NormalMatrix * gl_Normal; gl_Position = gl_ProjectionMatrix * e; }",
        "gl_Vertex", [](Vec4 v) { return kMvp * v; });
    same_as("#version 120\nvoid main() { gl_Position = gl_Vertex * gl_ModelViewProjectionMatrixTranspose; }",
            "gl_Vertex", [](Vec4 v) { return kMvp * v; });
    same_as(
        "#version 120\nvoid main() { gl_Position = gl_ProjectionMatrix * gl_ModelViewMatrixInverse *\n"
        "  (gl_ModelViewMatrix * gl_Vertex); }",
        "gl_Vertex", [](Vec4 v) { return kProjection * v; });
    same_as(
        "#version 120\nvoid main() { gl_Position = gl_ModelViewMatrixInverseTranspose *\n"
        "  transpose(gl_ModelViewMatrix) * gl_Vertex; }",
        "gl_Vertex", [](Vec4 v) { return v; });
}

// ---- uniforms ----

TEST(PositionRecogniser, Uniforms) {
    same_as("uniform mat4 mvp; attribute vec3 place; void main() { gl_Position = mvp * vec4(place, 1.0); }", "place",
            [](Vec4 v) { return matrix_of("mvp") * v; });
    same_as(
        "#version 330 core\nuniform mat4 p, v, m; layout(location = 3) in vec4 place; in vec3 normal;\n"
        "out vec3 n; void main() { n = mat3(m) * normal; gl_Position = p * v * m * place; gl_PointSize = 2.0; }",
        "place", [](Vec4 v) { return matrix_of("p") * matrix_of("v") * matrix_of("m") * v; });
    same_as("#version 140\nuniform mat4 bones[4]; in vec4 place; void main() { gl_Position = bones[2] * place; }",
            "place", [](Vec4 v) { return matrix_of("bones", 2) * v; });
    same_as(
        "#version 130\nstruct Camera { vec4 shift; mat4 view[2]; }; uniform struct { float f; Camera c[2]; } u;\n"
        "in vec4 place; void main() { gl_Position = u.c[1].view[1] * place + u.c[1].shift; }",
        "place", [](Vec4 v) {
            const auto shift = values_of({"u.c[1].shift", 0}, 4);
            Vec4 out = matrix_of("u.c[1].view", 1) * v;
            for (int i = 0; i < 4; ++i) out[i] += shift[i];
            return out;
        });
    const RecognisedPosition found = recognise(
        "#version 150\nuniform mat4 mvp = mat4(2.0), unused; in vec4 p; void main() { gl_Position = mvp * p; }");
    EXPECT_EQ(found.program.uniforms, (std::vector<glapi::PositionUniform>{{"mvp", 0}}));
    EXPECT_EQ(found.program.steps.size(), 3u);
}

TEST(PositionRecogniser, LanguageOfEs) {
    same_as("#version 100\nattribute vec4 p; uniform mat4 m; void main() { gl_Position = m * p; }", "p",
            [](Vec4 v) { return matrix_of("m") * v; });
    same_as(
        "#version 300 es\nin vec3 p; uniform mat4 m; out mediump vec2 t;\n"
        "void main() { t = p.xy; gl_Position = m * vec4(p, 1); }",
        "p", [](Vec4 v) { return matrix_of("m") * v; });
    same_as("#version 310 es\nin vec3 p; uniform mat4 m; void main() { gl_Position = m * vec4(p, 1); }", "p",
            [](Vec4 v) { return matrix_of("m") * v; });
    not_recognised(
        "#version 100\nprecision mediump float; attribute vec4 p; uniform highp mat4 m;\n"
        "void main() { gl_Position = m * p; }",
        WhyUnknown::not_a_float);
    not_recognised("#version 100\nattribute vec4 p; uniform mediump mat4 m; void main() { gl_Position = m * p; }",
                   WhyUnknown::not_a_float);
    not_recognised("#version 100\nattribute vec4 p; void main() { mediump vec4 q = p; gl_Position = q; }",
                   WhyUnknown::not_a_float);
    same_as("#version 130\nprecision mediump float; in vec4 p; uniform mat4 m; void main() { gl_Position = m * p; }",
            "p", [](Vec4 v) { return matrix_of("m") * v; });
}

// ---- arithmetic ----

TEST(PositionRecogniser, Arithmetic) {
    same_as(
        "attribute vec2 p; uniform vec2 scale, shift; uniform float f;\n"
        "void main() { gl_Position = vec4(p * scale / f - shift, 0.0, 1.0); }",
        "p", [](Vec4 v) {
            const auto scale = values_of({"scale"}, 2), shift = values_of({"shift"}, 2), f = values_of({"f"}, 1);
            return Vec4{v[0] * scale[0] / f[0] - shift[0], v[1] * scale[1] / f[0] - shift[1], 0, 1};
        });
    same_as("attribute vec3 p; void main() { gl_Position = vec4(-p.zyx, 2.0).wxyz; gl_Position.yz *= 2.0; }", "p",
            [](Vec4 v) {
                return Vec4{2, -2 * v[2], -2 * v[1], -v[0]};
            });
    same_as("attribute vec4 p; void main() { vec4 q = p; q.x++; --q.y; q[2] = q.w; gl_Position = q; }", "p",
            [](Vec4 v) {
                return Vec4{v[0] + 1, v[1] - 1, 1, 1};
            });
    same_as(
        "uniform mat4 m; attribute vec4 p; void main() { gl_Position = mix(p, m[1], 0.25);\n"
        "  gl_Position.w = dot(p, m[0]) + dot(vec3(1.0, 2.0, 3.0), p.xyz); }",
        "p", [](Vec4 v) {
            const Mat4 m = matrix_of("m");
            Vec4 out;
            for (int i = 0; i < 4; ++i) out[i] = 0.75f * v[i] + 0.25f * m[4 + i];
            out[3] = v[0] + 2 * v[1] + 3 * v[2];
            for (int i = 0; i < 4; ++i) out[3] += v[i] * m[i];
            return out;
        });
    same_as(
        "#version 120\nuniform mat4 m; attribute vec3 p;\n"
        "void main() { mat3 r = mat3(m); r[1].x = 5.0; r *= 2.0; gl_Position = mat4(r) * vec4(p, 1.0); }",
        "p", [](Vec4 v) {
            Mat4 m = matrix_of("m");
            m[4] = 5;
            for (float& x : m) x *= 2;
            for (int i = 0; i < 4; ++i) m[12 + i] = m[4 * i + 3] = i == 3 ? 1.0f : 0.0f;
            return m * v;
        });
    same_as(
        "#version 150\nuniform mat4 m; in vec4 p;\n"
        "void main() { mat4 n = m; n *= transpose(m); gl_Position = inverse(n) * (n * p); gl_Position += p * n; }",
        "p", [](Vec4 v) {
            const Mat4 n = matrix_of("m") * transposed(matrix_of("m"));
            Vec4 out = transposed(n) * v;
            for (int i = 0; i < 4; ++i) out[i] += v[i];
            return out;
        });
    // A quaternion turns the vertex.
    same_as(
        "uniform vec4 q; attribute vec3 p; void main() { vec3 t = 2.0 * cross(q.xyz, p);\n"
        "  gl_Position = vec4(p + q.w * t + cross(q.xyz, t), 1.0); }",
        "p", [](Vec4 v) {
            const auto q = values_of({"q"}, 4);
            const auto cross = [&](Vec4 b) {
                return Vec4{q[1] * b[2] - q[2] * b[1], q[2] * b[0] - q[0] * b[2], q[0] * b[1] - q[1] * b[0], 0};
            };
            Vec4 t = cross(v);
            for (float& x : t) x *= 2;
            const Vec4 u = cross(t);
            return Vec4{v[0] + q[3] * t[0] + u[0], v[1] + q[3] * t[1] + u[1], v[2] + q[3] * t[2] + u[2], 1};
        });
    // What is used twice is there once.
    std::string doubling = "attribute vec4 p; void main() { vec4 q = p;";
    for (int i = 0; i < 60; ++i) doubling += " q += q;";
    const RecognisedPosition found = recognise(doubling + " gl_Position = q; }");
    EXPECT_EQ(found.program.steps.size(), 61u);
}

// ---- the way through the shader ----

TEST(PositionRecogniser, Functions) {
    same_as(
        "uniform mat4 m; attribute vec3 p; varying float fog;\n"
        "vec4 place(in vec3 q, out float far) { far = 2.0; vec4 r = vec4(q, 1.0); return m * r; }\n"
        "float thick(vec3 q) { if (q.z > 1.0) return 0.0; return length(q); }\n"
        "void finish(inout vec4 q) { q.y = -q.y; }\n"
        "void main() { float far; vec4 at = place(p * 2.0, far); fog = thick(p); at.x += far; finish(at);\n"
        "  gl_Position = at; }",
        "p", [](Vec4 v) {
            Vec4 out = matrix_of("m") * Vec4{2 * v[0], 2 * v[1], 2 * v[2], 1};
            return Vec4{out[0] + 2, -out[1], out[2], out[3]};
        });
    same_as(
        "vec4 at = vec4(1.0); void put() { gl_Position = gl_Vertex + at; }\n"
        "void main() { at.x = 3.0; put(); gl_FrontColor = gl_Position; return; }",
        "gl_Vertex", [](Vec4 v) {
            return Vec4{v[0] + 3, v[1] + 1, v[2] + 1, 2};
        });
}

TEST(PositionRecogniser, SeveralShaders) {
    glapi::ProgramDefinition definition;
    definition.shaders = {{GL_VERTEX_SHADER, true, "vec4 place(); void main() { gl_Position = place(); }"},
                          {GL_VERTEX_SHADER, true, "uniform mat4 m; vec4 place() { return m * gl_Vertex; }"}};
    const auto found = recognise_position(definition);
    ASSERT_TRUE(found.program.known()) << found.reason;
    EXPECT_EQ(evaluated(found.program), matrix_of("m"));
    definition.shaders.push_back({GL_GEOMETRY_SHADER, true, "#version 150\n"});
    EXPECT_EQ(recognise_position(definition).reason, "another stage moves vertices");
    definition.shaders.pop_back();
    definition.feedback.names = {"gl_Position"};
    EXPECT_EQ(recognise_position(definition).reason, "vertices are captured");
    EXPECT_FALSE(recognise_position({}).program.known());
}

TEST(PositionRecogniser, BranchesAndLoops) {
    same_as(
        "uniform bool lit; uniform mat4 m; varying vec4 c; void main() { vec4 e;\n"
        "  if (lit) { c = vec4(1.0); e = m * gl_Vertex; } else { c = gl_Color; e = m * gl_Vertex; }\n"
        "  for (int i = 0; i < 3; i++) { c += vec4(i); if (c.x > 2.0) break; }\n"
        "  gl_Position = lit ? e : m * gl_Vertex; }",
        "gl_Vertex", [](Vec4 v) { return matrix_of("m") * v; });
    not_recognised("uniform bool b; void main() { gl_Position = gl_Vertex; if (b) gl_Position.x = 2.0; }",
                   WhyUnknown::depends_on_flow);
    not_recognised("uniform bool b; void main() { gl_Position = b ? gl_Vertex : ftransform(); }",
                   WhyUnknown::depends_on_flow);
    not_recognised("uniform bool b; void main() { gl_Position = vec4(2.0); if (b) return; gl_Position = gl_Vertex; }",
                   WhyUnknown::depends_on_flow);
    not_recognised("void main() { vec4 q = gl_Vertex; for (int i = 0; i < 3; ++i) q += q; gl_Position = q; }",
                   WhyUnknown::depends_on_flow);
    not_recognised(
        "uniform float f; void main() { float g = f; bool b = f > 0.0 && g++ > 1.0;\n"
        "  gl_Position = gl_Vertex * g; }",
        WhyUnknown::depends_on_flow);
    not_recognised(
        "vec4 at; void move() { at.x = 2.0; } void main() { at = gl_Vertex;\n"
        "  for (int i = 0; i < 3; ++i) move(); gl_Position = at; }",
        WhyUnknown::depends_on_flow);
    not_recognised(
        "#version 130\nuniform int i; in vec4 p; void main() { vec4 q = p;\n"
        "  switch (i) { case 1: q.x = 2.0; break; default: q.w = 1.0; } gl_Position = q; }",
        WhyUnknown::depends_on_flow);
    not_recognised(
        "vec4 at(vec4 p) { if (p.x > 0.0) return p; return -p; } void main() { gl_Position = at(gl_Vertex); }",
        WhyUnknown::depends_on_flow);
    not_recognised("#version 130\nin vec4 p; void main() { vec4 q = p; modf(p.x, q.y); gl_Position = q; }",
                   WhyUnknown::depends_on_flow);
    not_recognised("uniform int i; void main() { vec4 q = gl_Vertex; q[i] = 1.0; gl_Position = q; }",
                   WhyUnknown::depends_on_flow);
}

TEST(PositionRecogniser, StructuresAndArrays) {
    same_as(
        "#version 120\nstruct V { vec4 at; vec3 n; }; void main() { V v; v.at = gl_Vertex; v.n = gl_Normal;\n"
        "  vec4 a[2]; a[1] = v.at; a[0] = gl_Color; gl_Position = a[1] * 2.0; }",
        "gl_Vertex", [](Vec4 v) {
            return Vec4{2 * v[0], 2 * v[1], 2 * v[2], 2};
        });
    same_as(
        "#version 410\nin vec4 p; out V { vec4 at; } o; out gl_PerVertex { vec4 gl_Position; };\n"
        "void main() { o.at = p; gl_Position = o.at; }",
        "p", [](Vec4 v) { return v; });
    not_recognised(
        "#version 120\nuniform int i; void main() { vec4 a[2]; a[0] = gl_Vertex; a[1] = a[0]; a[i].x = 1.0;\n"
        "  gl_Position = a[1]; }",
        WhyUnknown::not_written);
    not_recognised(
        "#version 330\nlayout(std140) uniform B { mat4 m; }; in vec4 p; void main() { gl_Position = m * p; }",
        WhyUnknown::in_a_block);
}

// ---- what is not recognised ----

TEST(PositionRecogniser, OnlyOneAttribute) {
    same_as("attribute vec4 p, q; varying vec4 c; void main() { c = q * p; gl_Position = p; }", "p",
            [](Vec4 v) { return v; });
    same_as("attribute vec4 p, q; varying vec4 c; void main() { c = p; gl_Position = q; }", "q",
            [](Vec4 v) { return v; });
    not_recognised("attribute vec4 p; attribute vec3 offset; void main() { gl_Position = p + vec4(offset, 0.0); }",
                   WhyUnknown::two_attributes);
    not_recognised(
        "attribute vec4 p; attribute float h; void main() { gl_Position = vec4(p.xy, h, 1.0); gl_Position *= 2.0; }",
        WhyUnknown::two_attributes);
    not_recognised("attribute vec2 p; attribute float h; void main() { gl_Position = vec4(p, 0.0, h); }",
                   WhyUnknown::two_attributes);
    // Skinning.
    not_recognised(
        "#version 130\nuniform mat4 bones[8]; in ivec4 bone; in vec4 weight; in vec4 p; void main() {\n"
        "  gl_Position = bones[bone.x] * p * weight.x; }",
        WhyUnknown::not_affine);
    not_recognised("attribute mat4 m; attribute vec4 p; void main() { gl_Position = m * p; }", WhyUnknown::not_affine);
    not_recognised("#version 330\nin vec4 p; void main() { gl_Position = p + vec4(gl_InstanceID); }",
                   WhyUnknown::not_affine);
}

TEST(PositionRecogniser, OnlyAffine) {
    not_recognised("void main() { gl_Position = gl_Vertex * gl_Vertex; }", WhyUnknown::not_affine);
    not_recognised("void main() { gl_Position = gl_Vertex / gl_Vertex.w; }", WhyUnknown::not_affine);
    not_recognised("void main() { gl_Position = gl_Vertex; gl_Position.y = sin(gl_Vertex.x); }",
                   WhyUnknown::not_affine);
    not_recognised("uniform sampler2D t; void main() { gl_Position = gl_Vertex + texture2D(t, gl_Vertex.xy); }",
                   WhyUnknown::not_affine);
    not_recognised("void main() { gl_Position = vec4(1.0); }", WhyUnknown::not_affine);
    not_recognised("void main() { gl_Position.xyz = gl_Vertex.xyz; }", WhyUnknown::not_written);
    not_recognised("void main() { gl_FrontColor = gl_Vertex; }", WhyUnknown::not_written);
    not_recognised("void main() { gl_Position = gl_TextureMatrix[0] * gl_Vertex; }", WhyUnknown::other_state);
    not_recognised("#version 410\nin dvec4 p; void main() { gl_Position = vec4(p); }", WhyUnknown::not_affine);
}

TEST(PositionRecogniser, DepthMayBeAnything) {
    const RecognisedPosition found = recognise(
        "uniform mat4 m; uniform float far; void main() { gl_Position = m * gl_Vertex;\n"
        "  gl_Position.z = (log(gl_Position.w) * far - 1.0) * gl_Position.w; }");
    ASSERT_TRUE(found.program.known()) << found.reason;
    EXPECT_FALSE(found.program.depth);
    EXPECT_FALSE(
        recognise("void main() { gl_Position = gl_Vertex; gl_Position.w = log(gl_Vertex.w); }").program.known());
}

TEST(PositionRecogniser, ShadersThatWriteElsewhere) {
    EXPECT_FALSE(recognise("#version 430\nlayout(std430) buffer B { float f; }; in vec4 p;\n"
                           "void main() { f = 1.0; gl_Position = p; }")
                     .program.known());
    EXPECT_FALSE(recognise("#version 430\nlayout(binding = 0) uniform atomic_uint n; in vec4 p;\n"
                           "void main() { atomicCounterIncrement(n); gl_Position = p; }")
                     .program.known());
    EXPECT_FALSE(recognise("#version 450\n#extension GL_ARB_shader_viewport_layer_array : require\nin vec4 p;\n"
                           "void main() { gl_ViewportIndex = 1; gl_Position = p; }")
                     .program.known());
}

TEST(PositionRecogniser, ConditionsOnExtensionsAreTheDriversAffair) {
    const std::string end = "void main() { gl_Position = ftransform(); }\n";
    EXPECT_TRUE(recognise("#version 120\n#extension GL_ARB_texture_rectangle : enable\n" + end).program.known());
    EXPECT_TRUE(recognise("// of GL_ARB_draw_instanced\n/* GL_ARB_x */ #ifdef GL_ES\n#endif\n" + end).program.known());
    EXPECT_TRUE(recognise("#if __VERSION__ > 100\n" + end + "#endif\n").program.known());
    EXPECT_TRUE(recognise("#ifdef GL_ARB_draw_instanced\n#extension GL_ARB_draw_instanced : enable\n#else\n# extension "
                          "GL_EXT_draw_instanced : enable\n#endif\n" +
                          end)
                    .program.known());
    EXPECT_TRUE(recognise("#ifdef GL_ARB_draw_instanced\n#ifdef GL_X\n\n#endif\n#endif\n" + end).program.known());
    EXPECT_TRUE(recognise("#ifdef GL_ARB_a\n#endif\n#ifdef GL_ARB_b\n#endif\n" + end).program.known()) << "two";
    EXPECT_FALSE(recognise("#ifdef GL_ARB_draw_instanced\n#define N 1\n#endif\n" + end).program.known());
    EXPECT_FALSE(recognise("#ifdef GL_ARB_a\n#endif\n#ifdef GL_ARB_b\nfloat f;\n#endif\n" + end).program.known());
    EXPECT_FALSE(recognise("#ifdef GL_ARB_a\n#extension GL_ARB_a : enable /*\n#endif */\nint i;\n#endif\n" + end)
                     .program.known());
    EXPECT_FALSE(recognise("#ifdef GL_ARB_a\n" + end).program.known());
    std::string deep;
    for (int i = 0; i < 10000; ++i) deep += "#ifdef GL_ARB_a\n";
    for (int i = 0; i < 10000; ++i) deep += "#endif\n";
    EXPECT_FALSE(recognise(deep.substr(0, kMostShaderBytes - 100) + end).program.known());
    EXPECT_FALSE(recognise("#if defined(GL_EXT_gpu_shader4)\nfloat f;\n#endif\n" + end).program.known());
    EXPECT_FALSE(recognise("#define a(x) GL##x\n" + end).program.known());
    EXPECT_FALSE(recognise("/* never ends " + end).program.known());
}

TEST(PositionRecogniser, HostileShaders) {
    EXPECT_FALSE(recognise("this is no shader").program.known());
    EXPECT_FALSE(recognise("").program.known());
    EXPECT_FALSE(recognise("void main() { main(); gl_Position = gl_Vertex; }").program.known());
    EXPECT_FALSE(
        recognise("void main() { gl_Position = gl_Vertex; }" + std::string(kMostShaderBytes, ' ')).program.known());
    // Functions that call the next one twice.
    std::string calls = "vec4 f0(vec4 p) { return p + p; }\n";
    for (int i = 1; i < 40; ++i) {
        const std::string before = "f" + std::to_string(i - 1);
        calls += "vec4 f" + std::to_string(i) + "(vec4 p) { return " + before + "(p) + " + before + "(p); }\n";
    }
    not_recognised(calls + "void main() { gl_Position = f39(gl_Vertex); }", WhyUnknown::too_long);
    // Long.
    std::string many = "void main() { vec4 q = gl_Vertex;";
    for (int i = 0; i < 400; ++i) many += " q = q.yxzw * " + std::to_string(i) + ".5;";
    not_recognised(many + " gl_Position = q; }", WhyUnknown::too_long);
    // Deep: what goes through such a tree takes a part of the stack for each level.
    const auto times = [](int n, const std::string& text) {
        std::string out;
        for (int i = 0; i < n; ++i) out += text;
        return out;
    };
    const std::string end = " gl_Position = gl_Vertex; }";
    for (const std::string& deep :
         {"void main() { float f = " + times(50000, "1.+") + "1.;" + end,
          "#define A " + times(300, "a+") + "a\n#define B " + times(300, "A+") + "A\nvoid main() { float a, f = B;" +
              end,
          "void main() { float f = " + times(20000, "(") + "1." + times(20000, ")") + ";" + end,
          "void main() " + times(20000, "{") + end + times(20000, "}"),
          "uniform bool b; void main() {" + times(10000, "if(b);else ") + ";" + end,
          "uniform bool b; void main() {" + times(10000, "if(b)") + ";" + end,
          "uniform float a; void main() { float f=" + times(3000, "a>1.?a:") + "a;" + end,
          "uniform float a; void main() { float f=" + times(3000, "sin(") + "a" + times(3000, ")") + ";" + end,
          "uniform float a; void main() { float f=" + times(7000, "-") + "a;" + end})
        EXPECT_FALSE(recognise(deep).program.known()) << deep.substr(0, 60);
}

TEST(PositionRecogniser, SeveralThreads) {
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([] {
            for (int k = 0; k < 5; ++k)
                EXPECT_TRUE(recognise("#version 330 compatibility\nvoid main() { gl_Position = ftransform(); }")
                                .program.known());
        });
    for (auto& thread : threads) thread.join();
}

}  // namespace
}  // namespace wall::tileserver
