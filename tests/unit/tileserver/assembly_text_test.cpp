// SPDX-License-Identifier: MIT
// The text of assembly programs: its tokens, what it reads, how fragment.position is replaced, and vertex programs
// whose position is recognised, each held against what its instructions say.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "tileserver/objects/assembly_patch.h"
#include "tileserver/objects/assembly_position.h"
#include "tileserver/objects/assembly_tokens.h"
#include "tileserver/objects/assembly_uses.h"

namespace wall::tileserver {
namespace {

using namespace std::string_literals;
using glapi::TextureTarget;

std::vector<std::string> texts(std::string_view source) {
    std::vector<std::string> out;
    for (const AssemblyToken& token : assembly_tokens(source)) out.emplace_back(token.text);
    return out;
}

TEST(AssemblyTokens, AreNamesNumbersAndCharacters) {
    EXPECT_EQ(texts("!!ARBvp1.0\nMOV r.x, -c[2..3].wzyx; # c[9]\nEND"),
              (std::vector<std::string>{"!!ARBvp1.0", "MOV", "r", ".", "x", ",", "-", "c", "[", "2", "..", "3", "]",
                                        ".", "wzyx", ";", "END"}));
    EXPECT_EQ(texts("1.5e-3,.5,2.,1E+4,3e2,2D"),
              (std::vector<std::string>{"1.5e-3", ",", ".5", ",", "2.", ",", "1E+4", ",", "3e2", ",", "2D"}));
    EXPECT_EQ(texts("vertex.attrib[0].x"),
              (std::vector<std::string>{"vertex", ".", "attrib", "[", "0", "]", ".", "x"}));
    for (const std::string& any : {""s, "!!"s, "#"s, "."s, ".."s, "1."s, "1e"s, "1e+"s, "\x00\xff"s, "["s}) texts(any);
}

TEST(AssemblyUses, Textures) {
    const auto found = find_textures(
        assembly_tokens("!!ARBfp1.0\nTEX r, c, texture[3], CUBE;\nTXP r, c, texture, 2D; # texture[5], 2D\n"
                        "TEX q, c, texture [ 3 ] , CUBE;\nTXB r, c, texture[1], SHADOWRECT;\nMOV r, texture[2];END"));
    EXPECT_EQ(found, (std::vector<glapi::AssemblyTexture>{
                         {3, TextureTarget::cube_map}, {0, TextureTarget::t2d}, {1, TextureTarget::rectangle}}));
}

TEST(AssemblyUses, GenericAttributes) {
    EXPECT_EQ(find_generic_attributes(assembly_tokens("!!ARBvp1.0\nATTRIB a = vertex.attrib[3];\n"
                                                      "MOV r, vertex.attrib[15];MOV r, vertex.attrib[99];END")),
              1u << 3 | 1u << 15);
}

// ---- the patch ----

TEST(AssemblyPatch, LeavesOthersAlone) {
    const std::string source = "!!ARBfp1.0\n# fragment.position\nMOV result.color, fragment.color;\nEND";
    const PatchedAssembly out = patch_fragment_program(source, 254);
    EXPECT_EQ(out.source, source);
    EXPECT_FALSE(out.reads_window);
}

TEST(AssemblyPatch, MakesATemporaryOfThePosition) {
    const PatchedAssembly out = patch_fragment_program(
        "!!ARBfp1.0\nOPTION ARB_precision_hint_nicest;OPTION ARB_fragment_coord_origin_upper_left;\n"
        "ATTRIB here = fragment.position;\nMOV result.color, here;\nMOV result.color.x, fragment . position.y;\nEND",
        254);
    EXPECT_EQ(out.source,
              "!!ARBfp1.0\nOPTION ARB_precision_hint_nicest;OPTION ARB_fragment_coord_origin_upper_left;\n"
              "TEMP wallgl_FragCoord;\n"
              "MAD wallgl_FragCoord, fragment.position, program.env[254], program.env[255];\n\n"
              "ALIAS here = wallgl_FragCoord;\nMOV result.color, here;\nMOV result.color.x, wallgl_FragCoord.y;\nEND");
    EXPECT_TRUE(out.reads_window && out.upper_left);
    EXPECT_FALSE(out.whole_centers);
}

TEST(AssemblyPatch, KnowsWhereThePixelsMiddlesAre) {
    EXPECT_TRUE(patch_fragment_program("!!ARBfp1.0\nOPTION ARB_fragment_coord_pixel_center_integer;\n"
                                       "MOV result.color, fragment.position;END",
                                       0)
                    .whole_centers);
}

TEST(AssemblyPatch, TakesAnyText) {
    for (const std::string& any : {""s, "fragment.position"s, "!!ARBfp1.0fragment"s, "OPTION"s, "ATTRIB"s, ";"s})
        patch_fragment_program(any, 1);
}

// ---- positions ----

using Vec4 = std::array<float, 4>;
using Mat4 = std::array<float, 16>;

constexpr Mat4 kModelview{1, 0.5f, 0, 0, -0.25f, 2, 0, 0.125f, 0, 0, 1, 0, 3, -1, -5, 1},
    kProjection{2, 0, 0, 0, 0, 1.5f, 0, 0, 0.25f, 0, -1, -1, 0, 0, -0.5f, 0};

Vec4 operator*(const Mat4& m, const Vec4& v) {
    Vec4 out{};
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t i = 0; i < 4; ++i) out[row] += m[4 * i + row] * v[i];
    return out;
}

/// Of a kind and a number, that are no pattern.
Vec4 parameter(const std::string& kind, std::uint32_t index) {
    const float first = static_cast<float>(index) * 0.5f + (kind == "env" ? 0.25f : 0);
    return {first, 1 - first, first * 0.5f, 2};
}

AssemblyPosition recognised(const std::string& text) {
    return recognise_assembly_position("!!ARBvp1.0\n" + text + "\nEND\n");
}

/// Where a program says that it puts (x, y, z, w).
Vec4 placed(const glapi::PositionProgram& program, const Vec4& vertex) {
    EXPECT_TRUE(is_valid(program));
    std::vector<Vec4> values;
    for (const auto& uniform : program.uniforms) values.push_back(parameter(uniform.name, uniform.element));
    const std::vector<std::span<const float>> given(values.begin(), values.end());
    const auto transform = evaluate(program, {given, kModelview, kProjection});
    if (!transform) return {};
    Vec4 out = transform->linear * vertex;
    for (std::size_t i = 0; i < 4; ++i) out[i] += transform->constant[i];
    return out;
}

constexpr Vec4 kSomewhere{0.5f, -2, 3, 1};

void expect_placed(const std::string& text, const Vec4& wanted, const std::string& attribute = "gl_Vertex") {
    SCOPED_TRACE(text);
    const AssemblyPosition found = recognised(text);
    ASSERT_TRUE(found.program.known()) << found.reason;
    EXPECT_FALSE(found.invariant);
    EXPECT_EQ(found.program.attribute, attribute);
    const Vec4 place = placed(found.program, kSomewhere);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(place[i], wanted[i], 1e-4f) << i;
}

bool has_camera(const std::string& text) {
    const auto found = recognised(text);
    const auto last = last_matrix(found.program);
    return last && last->built_in;
}

constexpr const char* kByRows =
    "DP4 result.position.x, state.matrix.mvp.row[0], vertex.position;"
    "DP4 result.position.y, state.matrix.mvp.row[1], vertex.position;"
    "DP4 result.position.z, state.matrix.mvp.row[2], vertex.position;"
    "DP4 result.position.w, state.matrix.mvp.row[3], vertex.position;";
constexpr const char* kByColumns =
    "PARAM m[] = { state.matrix.mvp.transpose }; ATTRIB v = vertex.position; TEMP r, s; OUTPUT o = result.position;"
    "MUL r, v.x, m[0]; MAD r, v.y, m[1], r; MAD r, v.z, m[2], r; MAD r, v.w, m[3], r; ALIAS again = r; MOV o, again;";
constexpr const char* kInTwoSteps =
    "PARAM p[4] = { state.matrix.projection }; PARAM m[4] = { state.matrix.modelview[0].row[0..3] }; TEMP e;"
    "DP4 e.x, m[0], vertex.position; DP4 e.y, vertex.position, m[1]; DP4 e.z, m[2], vertex.position;"
    "DP4 e.w, m[3], vertex.position;"
    "DP4 result.position.x, p[0], e; DP4 result.position.y, p[1], e; DP4 result.position.z, p[2], e;"
    "DP4 result.position.w, p[3], e;";

TEST(AssemblyPosition, IsFixedFunctions) {
    const AssemblyPosition found = recognised("OPTION ARB_position_invariant; MOV result.color, vertex.color;");
    EXPECT_TRUE(found.invariant);
    EXPECT_EQ(placed(found.program, kSomewhere), kProjection * (kModelview * kSomewhere));
    for (const char* text : {kByRows, kByColumns, kInTwoSteps})
        expect_placed(text, kProjection * (kModelview * kSomewhere));
}

TEST(AssemblyPosition, TellsTheCamera) {
    EXPECT_TRUE(has_camera("OPTION ARB_position_invariant;"));
    for (const char* text : {kByRows, kByColumns, kInTwoSteps}) EXPECT_TRUE(has_camera(text)) << text;
    EXPECT_FALSE(has_camera("ADD result.position, vertex.position, program.local[1];"));
}

TEST(AssemblyPosition, TakesParameters) {
    const Vec4 l1 = parameter("local", 1), e2 = parameter("env", 2);
    expect_placed("PARAM p = program.env[2]; MAD result.position, vertex.position, program.local[1], p;",
                  {kSomewhere[0] * l1[0] + e2[0], kSomewhere[1] * l1[1] + e2[1], kSomewhere[2] * l1[2] + e2[2],
                   kSomewhere[3] * l1[3] + e2[3]});
    expect_placed(
        "PARAM c[4] = { program.local[0..1], program.env[2], { 0.5, 1 } };"
        "ADD result.position, vertex.position, c[3];",
        {1, -1, 3, 2});
    expect_placed("PARAM half = 0.5; MUL result.position, -half, vertex.position.yxzw;", {1, -0.25f, -1.5f, -0.5f});
    expect_placed("SUB result.position, vertex.position, { 1, 2, 3, 0 };", {-0.5f, -4, 0, 1});
    expect_placed(
        "TEMP r; DPH r.x, vertex.position, program.local[1]; MOV r.yzw, vertex.position; MOV result.position, r;",
        {0.5f * l1[0] - 2 * l1[1] + 3 * l1[2] + l1[3], -2, 3, 1});
    expect_placed("SWZ result.position, vertex.position, -y, x, 0, 1;", {2, 0.5f, 0, 1});
    expect_placed("DP3 result.position.x, vertex.position, { 1, 1, 1, 9 }; MOV result.position.yzw, vertex.position;",
                  {1.5f, -2, 3, 1});
}

TEST(AssemblyPosition, KnowsWhichElementIsWhich) {
    expect_placed(
        "PARAM c[7] = { state.matrix.texture[1], state.matrix.program[0].row[2..3], { 2, 2, 2, 2 } };"
        "MUL result.position, vertex.position, c[6];",
        {1, -4, 6, 2});
    expect_placed(
        "PARAM c[] = { state.light[0].position, state.matrix.modelview[1].inverse, { 2, 2, 2, 2 } };"
        "MUL result.position, vertex.position, c[5];",
        {1, -4, 6, 2});
    for (const char* text : {"PARAM c[3] = { program.local[0..1] }; MOV result.position, vertex.position;",
                             "PARAM c[1] = { state.matrix.mvp.row[2..1] }; MOV result.position, vertex.position;",
                             "PARAM c = 1 + 2; MOV result.position, vertex.position;"})
        EXPECT_FALSE(recognised(text).program.known()) << text;
}

TEST(AssemblyPosition, OfAGenericAttribute) {
    expect_placed("MOV result.position, vertex.attrib[5];", kSomewhere, "5");
    expect_placed("MOV result.position, vertex.attrib[0];", kSomewhere);
}

TEST(AssemblyPosition, MayLackTheDepth) {
    const auto found = recognised("MOV result.position, vertex.position; EX2 result.position.z, vertex.position.z;");
    EXPECT_TRUE(found.program.known());
    EXPECT_FALSE(found.program.depth);
}

TEST(AssemblyPosition, IsNotGuessed) {
    for (const char* text : {
             "",
             "MOV result.color, vertex.color;",
             "MOV result.position.xyz, vertex.position;",
             "MUL result.position, vertex.position, vertex.position;",
             "ADD result.position, vertex.position, vertex.attrib[3];",
             "ADD result.position, vertex.position, vertex.normal;",
             "MUL result.position, vertex.position, vertex.color.secondary.x;",
             "MUL result.position, vertex.position, state.light[0].position;",
             "MUL result.position, vertex.position, state.matrix.texture[1].row[0];",
             "MUL result.position, vertex.position, state.matrix.modelview[1].row[0];",
             "ADDRESS a; PARAM c[3] = { program.local[0..2] }; ARL a.x, vertex.attrib[1].x;"
             "MUL result.position, vertex.position, c[a.x + 1];",
             "PARAM c[2] = { program.local[0..1] }; MUL result.position, vertex.position, c[7];",
             "TEMP r; MAD r, vertex.position, r, r; MOV result.position, r;",
             "MOV result.position, vertex.position; RCP result.position.x, vertex.position.x;",
             "OPTION NV_vertex_program2; MOV result.position, vertex.position;",
             "MOV result.position, unheard_of;",
             "MOV result.position, { 1, 2, 3, 4 };",
         }) {
        const auto found = recognised(text);
        EXPECT_FALSE(found.program.known()) << text;
        EXPECT_FALSE(found.invariant);
        EXPECT_FALSE(found.reason.empty()) << text;
    }
}

TEST(AssemblyPosition, TakesAnyText) {
    for (const std::string& any : {""s,
                                   "PARAM"s,
                                   "PARAM c["s,
                                   "PARAM c[1"s,
                                   "PARAM c[1] = {"s,
                                   "PARAM p = program.env[0..4294967295];"s,
                                   "TEMP"s,
                                   "TEMP ,"s,
                                   "ALIAS a"s,
                                   "ATTRIB"s,
                                   "OUTPUT"s,
                                   "MOV"s,
                                   "MOV result"s,
                                   "MOV result.position"s,
                                   "MOV result.position, -"s,
                                   "MOV result.position, state"s,
                                   "MOV result.position, state.matrix.mvp.row["s,
                                   "SWZ result.position, vertex.position"s,
                                   "MAD r, r"s,
                                   "MOV result.position.xyzwxyzw, vertex.position"s,
                                   "MOV result.position, vertex.position.xyzwx;"s,
                                   "PARAM c[] = { {1, 2, 3, 4, 5}, {"s})
        recognised(any);
    std::string doubled = "TEMP r; MOV r, vertex.position;";
    for (int i = 0; i < 3000; ++i) doubled += "ADD r, r, r;";
    EXPECT_FALSE(recognised(doubled + "MOV result.position, r;").program.known());
}

}  // namespace
}  // namespace wall::tileserver
