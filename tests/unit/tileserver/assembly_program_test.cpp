// SPDX-License-Identifier: MIT
// Assembly programs on a node: what is said of their text, what they draw, their parameters, fragment.position in the
// layers of a window's tiles, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <optional>

#include "common/glapi/assembly_format.h"
#include "tests/unit/tileserver/test_node.h"
#include "tileserver/gpu/caps.h"

namespace wall::tileserver::test {
namespace {

constexpr ClientName kVertices(1), kFragments(2);
const std::string kPlain = "!!ARBvp1.0\nMOV result.position, vertex.position;\nMOV result.color, vertex.color;\nEND";
const std::string kTinted = "!!ARBfp1.0\nMUL result.color, program.local[1], program.env[2];\nEND";
const std::string kHere =
    "!!ARBfp1.0\nTEMP r;\nMUL r, fragment.position, { 0.125, 0.125, 0, 0 };\nMOV r.zw, { 0, 0, 0, 1 };\n"
    "MOV result.color, r;\nEND";

class AssemblyProgramTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL";
        if (!node_.driver->has_assembly()) GTEST_SKIP() << "no assembly programs";
        node_.node->tiles = {{0, {0, 0, 4, 8}}, {1, {4, 0, 4, 8}}};
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(8, 8, {0, 0, 8, 8});
    }
    static void define(Batch& batch, ClientName name, GLenum target, const std::string& source) {
        pack::AssemblyDefine(batch.buffer(), name, target, encode(glapi::AssemblyDefinition{source, false, {}}));
    }
    static void use_fragments(Batch& batch) {
        batch.set<el::fragment_program>(kFragments.value).set<el::fragment_program_enabled>(1);
    }
    static void fill(Batch& batch) {
        batch.block(3, [](auto& b) {
            pack::Clear(b, GL_COLOR_BUFFER_BIT);
            pack::Begin(b, GL_QUADS);
            for (const auto& v :
                 {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}})
                pack::Vertex2f(b, v[0], v[1]);
            pack::End(b);
        });
    }
    Pixels drawn(Batch& batch, std::uint32_t slot, const geom::Rect& part) {
        fill(batch);
        session_->expect_run(batch);
        return session_->read(slot, part);
    }
    static void set_local(Batch& batch, std::uint32_t first, const std::vector<float>& values) {
        pack::AssemblyLocals(batch.buffer(), kFragments, first, std::as_bytes(std::span(values)));
    }
    glapi::AssemblyReflection asked(GLenum target, const std::string& source) {
        Batch batch;
        pack::ShaderCompile(batch.buffer(), RequestId(5), target, std::as_bytes(std::span(source)));
        session_->expect_run(batch);
        const auto said = glapi::decode_assembly_reflection(session_->replies[RequestId(5)]);
        EXPECT_TRUE(said);
        return said.value_or(glapi::AssemblyReflection{});
    }

    TestNode node_;
    std::optional<TestSession> session_;
};

TEST_F(AssemblyProgramTest, TheDriverSaysWhatItFinds) {
    const auto good = asked(GL_VERTEX_PROGRAM_ARB, kPlain);
    EXPECT_TRUE(good.compiled) << good.message;
    EXPECT_EQ(good.error_position, -1);
    EXPECT_EQ(good.counts[0], 3u) << "instructions, with END";
    EXPECT_TRUE(good.position.known());
    const auto bad = asked(GL_FRAGMENT_PROGRAM_ARB, "!!ARBfp1.0\nNONSENSE;\nEND");
    EXPECT_FALSE(bad.compiled);
    EXPECT_GT(bad.error_position, 0);
    EXPECT_FALSE(bad.message.empty());
    const auto sampling =
        asked(GL_FRAGMENT_PROGRAM_ARB, "!!ARBfp1.0\nTEX result.color, fragment.texcoord[0], texture[2], 3D;\nEND");
    EXPECT_EQ(sampling.textures, (std::vector<glapi::AssemblyTexture>{{2, glapi::TextureTarget::t3d}}));
}

TEST_F(AssemblyProgramTest, DrawsWithItsParameters) {
    Batch batch;
    define(batch, kFragments, GL_FRAGMENT_PROGRAM_ARB, kTinted);
    set_local(batch, 0, {9, 9, 9, 9, 1, 1, 0, 1});
    batch.set<el::fragment_env>({0, 1, 1, 1}, 2);
    use_fragments(batch);
    EXPECT_EQ(drawn(batch, 0, {1, 1, 1, 1}), (Pixels{0, 255, 0, 255}));
    Batch other;
    set_local(other, 1, {0, 1, 1, 1});
    EXPECT_EQ(drawn(other, 0, {1, 1, 1, 1}), (Pixels{0, 255, 255, 255}));
    Batch off;
    off.set<el::fragment_program_enabled>(0).set<el::color>({1, 0, 0, 1});
    EXPECT_EQ(drawn(off, 0, {1, 1, 1, 1}), (Pixels{255, 0, 0, 255}));
}

TEST_F(AssemblyProgramTest, AVertexProgramPlacesVertices) {
    Batch batch;
    define(batch, kVertices, GL_VERTEX_PROGRAM_ARB,
           "!!ARBvp1.0\nMUL result.position, vertex.position, program.env[0];\nMOV result.color, { 0, 0, 1, 1 };\nEND");
    batch.set<el::vertex_program>(kVertices.value).set<el::vertex_program_enabled>(1);
    batch.set<el::vertex_env>({0.5f, 1, 1, 1}, 0);
    EXPECT_EQ(drawn(batch, 0, {3, 4, 1, 1}), (Pixels{0, 0, 255, 255}));
    EXPECT_EQ(session_->read(0, {1, 4, 1, 1}), (Pixels{0, 0, 0, 255})) << "half as wide as the window";
}

TEST_F(AssemblyProgramTest, APlaceIsOneOfTheWindowOnEveryTile) {
    Batch batch;
    define(batch, kFragments, GL_FRAGMENT_PROGRAM_ARB, kHere);
    use_fragments(batch);
    const auto at = [](float x, float y) {
        const auto level = [](float v) { return static_cast<std::uint8_t>(v / 8 * 255 + 0.5f); };
        return Pixels{level(x), level(y), 0, 255};
    };
    EXPECT_EQ(drawn(batch, 0, {1, 6, 1, 1}), at(1.5f, 6.5f));
    EXPECT_EQ(session_->read(1, {5, 2, 1, 1}), at(5.5f, 2.5f));
}

TEST_F(AssemblyProgramTest, OneThatDoesNotCompileLeavesTheOneBefore) {
    Batch batch;
    define(batch, kFragments, GL_FRAGMENT_PROGRAM_ARB, "!!ARBfp1.0\nMOV result.color, { 0, 1, 0, 1 };\nEND");
    define(batch, kFragments, GL_FRAGMENT_PROGRAM_ARB, "!!ARBfp1.0\nNONSENSE;\nEND");
    use_fragments(batch);
    EXPECT_EQ(drawn(batch, 0, {1, 1, 1, 1}), (Pixels{0, 255, 0, 255}));
}

TEST_F(AssemblyProgramTest, OneWithoutATextIsFixedFunction) {
    Batch batch;
    define(batch, kFragments, GL_FRAGMENT_PROGRAM_ARB, "");
    set_local(batch, 3, {1, 2, 3, 4});
    batch.set<el::fragment_env>({0, 1, 1, 1}, 253).set<el::vertex_env>({0, 1, 1, 1}, 255);
    batch.set<el::program_matrix>(glstate::Mat4{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1}, 7);
    batch.set<el::color>({1, 0, 1, 1});
    use_fragments(batch);
    EXPECT_EQ(drawn(batch, 0, {1, 1, 1, 1}), (Pixels{255, 0, 255, 255}));
}

TEST_F(AssemblyProgramTest, OthersDrawAsIfItWasNotThere) {
    Batch batch;
    define(batch, kFragments, GL_FRAGMENT_PROGRAM_ARB, kTinted);
    use_fragments(batch);
    fill(batch);
    session_->expect_run(batch);
    TestSession other(*node_.node, SessionId(2));
    other.open_surface(8, 8, {0, 0, 8, 8});
    Batch plain;
    plain.set<el::color>({1, 1, 0, 1});
    plain.set<el::fragment_program>(kFragments.value).set<el::fragment_program_enabled>(1);  // it has none of that name
    fill(plain);
    other.expect_run(plain);
    EXPECT_EQ(other.read(0, {1, 1, 1, 1}), (Pixels{255, 255, 0, 255}));
}

TEST_F(AssemblyProgramTest, GivesTheDriversNamesBack) {
    const auto before = *node_.driver->gl().objects;
    Batch batch;
    define(batch, kFragments, GL_FRAGMENT_PROGRAM_ARB, kTinted);
    use_fragments(batch);
    fill(batch);
    session_->expect_run(batch);
    EXPECT_EQ(node_.driver->gl().objects->assembly_programs, before.assembly_programs + 1);
    Batch gone;
    pack::ObjectDelete(gone.buffer(), kFragments);
    gone.set<el::color>({0, 0, 1, 1});
    EXPECT_EQ(drawn(gone, 0, {1, 1, 1, 1}), (Pixels{0, 0, 255, 255}));
    EXPECT_EQ(node_.driver->gl().objects->assembly_programs, before.assembly_programs);
}

TEST_F(AssemblyProgramTest, WhatNoClientSendsIsRefused) {
    const auto refused = [&](auto&& say) {
        TestSession session(*node_.node, SessionId(3));
        Batch batch;
        define(batch, kFragments, GL_FRAGMENT_PROGRAM_ARB, kTinted);
        say(batch.buffer());
        return !session.run(batch);
    };
    const std::vector<float> four(4);
    const auto values = std::as_bytes(std::span(four));
    EXPECT_FALSE(refused([&](auto& b) { pack::AssemblyLocals(b, kFragments, 4095, values); }));
    EXPECT_TRUE(refused([&](auto& b) { pack::AssemblyLocals(b, kFragments, 4096, values); }));
    EXPECT_TRUE(refused([&](auto& b) { pack::AssemblyLocals(b, kFragments, ~0u, values); }));
    EXPECT_TRUE(refused([&](auto& b) { pack::AssemblyLocals(b, kFragments, 0, values.first(12)); }));
    EXPECT_TRUE(refused([&](auto& b) { pack::AssemblyLocals(b, kVertices, 0, values); }));
    EXPECT_TRUE(refused([&](auto& b) { pack::AssemblyDefine(b, kVertices, GL_TEXTURE_2D, values); }));
    EXPECT_TRUE(refused([&](auto& b) { pack::AssemblyDefine(b, kVertices, GL_VERTEX_PROGRAM_ARB, values.first(8)); }));
    const auto definition = encode(glapi::AssemblyDefinition{kPlain, false, {}});
    EXPECT_TRUE(refused([&](auto& b) { pack::AssemblyDefine(b, kFragments, GL_VERTEX_PROGRAM_ARB, definition); }));
}

TEST_F(AssemblyProgramTest, TheNodesOwnParametersAreNotOffered) {
    const GlCaps caps = query_caps(node_.driver->gl());
    const auto found = std::ranges::find(caps.limits, GLenum{GL_MAX_PROGRAM_ENV_PARAMETERS_ARB}, &GlCaps::Limit::name);
    ASSERT_NE(found, caps.limits.end());
    EXPECT_EQ(found->values[1], static_cast<double>(node_.driver->window_parameter()));
}

// The window's own, whatever the tiles show of it.
TEST_F(AssemblyProgramTest, RasterPositionIsWhatTheVertexProgramMakes) {
    Batch batch;
    define(
        batch, kVertices, GL_VERTEX_PROGRAM_ARB,
        "!!ARBvp1.0\nADD result.position, vertex.position, { 0.5, 0, 0, 0 };\nMOV result.color, { 0.25, 0.5, 1, 1 };\n"
        "MOV result.texcoord[1], vertex.color;\nEND");
    batch.set<el::vertex_program>(kVertices.value).set<el::vertex_program_enabled>(1);
    batch.set<el::color>({1, 0.5f, 0.25f, 1});
    pack::RasterPosition(batch.buffer(), RequestId(6), -0.25f, 0.5f, 0.5f, 1);
    pack::RasterPosition(batch.buffer(), RequestId(7), 0.75f, 0, 0, 1);
    session_->expect_run(batch);
    const auto raster = [&](RequestId request) {
        glstate::RasterState out;
        EXPECT_EQ(session_->replies[request].size(), sizeof out);
        std::memcpy(&out, session_->replies[request].data(), sizeof out);
        return out;
    };
    const auto inside = raster(RequestId(6));
    EXPECT_EQ(inside.raster_position_valid, 1u);
    EXPECT_EQ(inside.raster_position, (glstate::Vec4{5, 6, 0.75f, 1}));
    EXPECT_EQ(inside.raster_color, (glstate::Vec4{0.25f, 0.5f, 1, 1}));
    EXPECT_EQ(inside.raster_texcoord[1], (glstate::Vec4{1, 0.5f, 0.25f, 1}));
    EXPECT_EQ(raster(RequestId(7)).raster_position_valid, 0u) << "right of the window";
}

}  // namespace
}  // namespace wall::tileserver::test
