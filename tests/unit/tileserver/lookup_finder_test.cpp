// SPDX-License-Identifier: MIT
// Samplers that are looked up at one place only are found, with the place as a function of an attribute; others are
// not.
#include "tileserver/objects/lookup_finder.h"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tileserver/objects/position_recogniser.h"

namespace wall::tileserver {
namespace {

std::vector<glapi::TextureLookup> lookups(const std::string& vertex, const std::string& fragment) {
    glapi::ProgramDefinition definition;
    definition.shaders = {{GL_VERTEX_SHADER, true, vertex}, {GL_FRAGMENT_SHADER, true, fragment}};
    const RecognisedPosition found = recognise_position(definition);
    EXPECT_TRUE(found.program.known()) << found.reason;
    return found.lookups;
}

/// Where a vertex with this attribute is looked up; all uniforms have these values, as far as they have components.
std::array<float, 2> place(const glapi::PositionProgram& coordinates, const std::array<float, 4>& attribute,
                           const std::vector<float>& uniform = {}) {
    EXPECT_TRUE(is_valid(coordinates));
    std::vector<std::span<const float>> uniforms;
    for (std::size_t i = 0; i < coordinates.uniforms.size(); ++i) uniforms.emplace_back(uniform);
    const std::array<float, 16> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const auto transform = evaluate(coordinates, {uniforms, identity, identity});
    EXPECT_TRUE(transform);
    std::array<float, 2> out{};
    for (std::size_t row = 0; transform && row < 2; ++row) {
        out[row] = transform->constant[row];
        for (std::size_t i = 0; i < 4; ++i) out[row] += transform->linear[4 * i + row] * attribute[i];
    }
    return out;
}

const std::string kVertex =
    "#version 120\nattribute vec3 place; attribute vec2 corner; varying vec2 uv;\n"
    "void main() { uv = corner; gl_Position = vec4(place, 1.0); }";

TEST(LookupFinder, WhatThePlaceIsMadeOf) {
    const auto plain = lookups(kVertex,
                               "#version 120\nuniform sampler2D picture; varying vec2 uv;\n"
                               "void main() { gl_FragColor = texture2D(picture, uv); }");
    ASSERT_EQ(plain.size(), 1u);
    EXPECT_EQ(plain[0].sampler, "picture");
    EXPECT_EQ(plain[0].coordinates.attribute, "corner");
    EXPECT_EQ(place(plain[0].coordinates, {0.25f, 0.75f, 0, 1}), (std::array{0.25f, 0.75f}));

    // As toolkits bring pictures to a window: two matrices, a choice, an opacity; with extensions that may be there.
    const auto toolkit = lookups(
        "#version 120\n#define highp\nattribute highp vec3 vertexCoord;attribute highp vec2 textureCoord;\n"
        "varying highp vec2 uv;uniform highp mat4 vertexTransform;uniform highp mat3 textureTransform;\n"
        "void main() { uv = (textureTransform * vec3(textureCoord,1.0)).xy;\n"
        "  gl_Position = vertexTransform * vec4(vertexCoord,1.0); }",
        "#version 120\n#ifdef GL_KHR_blend_equation_advanced\n#extension GL_ARB_fragment_coord_conventions : enable\n"
        "#extension GL_KHR_blend_equation_advanced : enable\n#endif\n#define highp\n"
        "varying highp vec2 uv;uniform sampler2D textureSampler;uniform bool swizzle;uniform highp float opacity;\n"
        "void main() { highp vec4 c = texture2D(textureSampler,uv); c.a *= opacity;\n"
        "  gl_FragColor = swizzle ? c.bgra : c; }");
    ASSERT_EQ(toolkit.size(), 1u);
    EXPECT_EQ(toolkit[0].coordinates.attribute, "textureCoord");
    ASSERT_EQ(toolkit[0].coordinates.uniforms.size(), 1u);
    EXPECT_EQ(toolkit[0].coordinates.uniforms[0].name, "textureTransform");
    EXPECT_EQ(place(toolkit[0].coordinates, {0.5f, 1, 0, 1}, {2, 0, 0, 0, -1, 0, 0.25f, 3, 1}),
              (std::array{1.25f, 2.0f}));

    // Of the position itself; of two samplers, and of one twice.
    const auto both = lookups(
        "#version 330 core\nin vec2 place; out vec4 at; void main() { at = vec4(place * 0.5 + 0.5, 0, 0);\n"
        "  gl_Position = vec4(place, 0, 1); }",
        "#version 330 core\nuniform sampler2D color, depth; in vec4 at; out vec4 result;\n"
        "void main() { result = texture(color, at.xy) * texture(depth, at.xy).r + texture(color, at.st); }");
    ASSERT_EQ(both.size(), 2u);
    for (const auto& lookup : both) EXPECT_EQ(place(lookup.coordinates, {-1, 0.5f, 0, 1}), (std::array{0.0f, 0.75f}));

    const auto fixed_function =
        lookups("void main() { gl_TexCoord[1] = gl_MultiTexCoord1; gl_Position = ftransform(); }",
                "uniform sampler2D s; void main() { gl_FragColor = texture2D(s, gl_TexCoord[1].st); }");
    ASSERT_EQ(fixed_function.size(), 1u);
    EXPECT_EQ(fixed_function[0].coordinates.attribute, "gl_MultiTexCoord1");

    const auto es = lookups(
        "#version 310 es\nlayout(location = 0) in vec4 v; layout(location = 3) out highp vec2 uv;\n"
        "void main() { uv = v.zw; gl_Position = vec4(v.xy, 0, 1); }",
        "#version 310 es\nprecision highp float; uniform sampler2D s; layout(location = 3) in highp vec2 uv;\n"
        "out vec4 c; void main() { c = texture(s, uv); }");
    ASSERT_EQ(es.size(), 1u);
    EXPECT_EQ(place(es[0].coordinates, {9, 9, 0.5f, 0.25f}), (std::array{0.5f, 0.25f}));
}

TEST(LookupFinder, WhatIsLookedUpElsewhere) {
    const auto head = std::string("#version 120\nuniform sampler2D s; uniform vec2 step; varying vec2 uv;\n");
    for (const char* body : {
             "void main() { gl_FragColor = texture2D(s, uv + step); }",
             "void main() { gl_FragColor = texture2D(s, uv) + texture2D(s, uv + step); }",
             "void main() { gl_FragColor = texture2D(s, uv.yx); }",
             "void main() { gl_FragColor = texture2D(s, uv, 1.0); }",
             "void main() { gl_FragColor = texture2D(s, texture2D(s, uv).xy); }",
             "void main() { gl_FragColor = texture2D(s, gl_FragCoord.xy); }",
             "void main() { gl_FragColor = texture2DProj(s, vec3(uv, 1.0)); }",
             "vec4 at(sampler2D t) { return texture2D(t, step); } void main() { gl_FragColor = at(s); }",
             "void main() { vec4 c = texture2D(s, uv); gl_FragColor = c + dFdx(c); }",
             "void main() { vec4 c = texture2D(s, uv); gl_FragColor = vec4(fwidth(c.r)); }",
         })
        EXPECT_TRUE(lookups(kVertex, head + body).empty()) << body;
    const std::string plain = "void main() { gl_FragColor = texture2D(s, uv); }";
    EXPECT_EQ(lookups(kVertex, head + plain).size(), 1u);
    EXPECT_TRUE(lookups(kVertex, head + plain + std::string(20000, ' ')).empty()) << "long";
    EXPECT_TRUE(lookups(kVertex,
                        "#version 120\nuniform sampler2D s[2]; varying vec2 uv; void main() { gl_FragColor = "
                        "texture2D(s[0], uv); }")
                    .empty());
    EXPECT_TRUE(lookups(kVertex,
                        "#version 120\nuniform sampler2DShadow s; varying vec2 uv; void main() { gl_FragColor "
                        "= shadow2D(s, vec3(uv, 1)); }")
                    .empty());
}

TEST(LookupFinder, PlacesThatAreNoFunctionOfOneAttribute) {
    const std::string fragment =
        "#version 130\nuniform sampler2D s; in vec2 uv; out vec4 c; void main() { c = texture(s, uv); }";
    const std::string head =
        "#version 130\nin vec4 place; in vec2 corner, other; out vec2 uv; uniform sampler2D s;\n"
        "void main() { gl_Position = place;";
    EXPECT_EQ(lookups(head + " uv = corner; }", fragment).size(), 1u);
    EXPECT_TRUE(lookups(head + " uv = corner + other; }", fragment).empty());
    EXPECT_TRUE(lookups(head + " uv = corner * corner; }", fragment).empty());
    EXPECT_TRUE(lookups(head + " uv = vec2(0.5); }", fragment).empty());
    EXPECT_TRUE(lookups(head + " uv = corner; if (place.x > 0.0) uv = other; }", fragment).empty());
    EXPECT_TRUE(lookups(head + " }", fragment).empty()) << "not written";
    EXPECT_TRUE(lookups(head + " uv = corner; gl_Position.z = texture(s, vec2(0.0)).r; }", fragment).empty());
    // What is handed on otherwise than as it is at a fragment's middle, and with fewer bits.
    const std::string plain = " uv = corner; }";
    EXPECT_TRUE(lookups("#version 130\nin vec4 place; in vec2 corner; flat out vec2 uv; void main() { gl_Position = "
                        "place;" +
                            plain,
                        "#version 130\nuniform sampler2D s; flat in vec2 uv; out vec4 c; void main() { c = texture(s, "
                        "uv); }")
                    .empty());
    EXPECT_TRUE(lookups("#version 300 es\nin vec4 place; in vec2 corner; out mediump vec2 uv; void main() { "
                        "gl_Position = place;" +
                            plain,
                        "#version 300 es\nprecision mediump float; uniform sampler2D s; in mediump vec2 uv; out vec4 "
                        "c; void main() { c = texture(s, uv); }")
                    .empty());
    // By their locations these are two.
    EXPECT_TRUE(lookups("#version 410\nin vec4 place; in vec2 corner; layout(location = 1) out vec2 uv;\n"
                        "layout(location = 2) out vec2 at; void main() { gl_Position = place; at = vec2(0);" +
                            plain,
                        "#version 410\nuniform sampler2D s; layout(location = 2) in vec2 uv; out vec4 c;\n"
                        "void main() { c = texture(s, uv); }")
                    .empty());
}

}  // namespace
}  // namespace wall::tileserver
