// SPDX-License-Identifier: MIT
// What OpenGL 4.0 adds to programs, on a node: tessellation and its patches, doubles, subroutines; and what a stream
// may say about them that no client does.
#include <gtest/gtest.h>

#include <bit>
#include <optional>

#include "common/glapi/program_format.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver {
namespace {

using test::Batch;
using test::Pixels;
using test::TestNode;
using test::TestSession;
namespace el = glstate::el;
namespace pack = glapi::pack;

constexpr ClientName kProgram(1);
const Pixels kGreen{0, 255, 0, 255}, kRed{255, 0, 0, 255}, kBlack{0, 0, 0, 255};

constexpr const char* kVertex = "#version 400\nin vec4 place; void main() { gl_Position = place; }";

/// A patch of four vertices becomes a square.
const glapi::ProgramDefinition kTessellated{
    {{GL_VERTEX_SHADER, true, kVertex},
     {GL_TESS_EVALUATION_SHADER, true,
      "#version 400\nlayout(quads) in; void main() {\n"
      "  gl_Position = mix(mix(gl_in[0].gl_Position, gl_in[1].gl_Position, gl_TessCoord.x),\n"
      "                    mix(gl_in[3].gl_Position, gl_in[2].gl_Position, gl_TessCoord.x), gl_TessCoord.y); }"},
     {GL_FRAGMENT_SHADER, true, "#version 400\nout vec4 color; void main() { color = vec4(0, 1, 0, 1); }"}},
    {{0, "place"}},
    {}};

const glapi::ProgramDefinition kNumbers{
    {{GL_VERTEX_SHADER, true, kVertex},
     {GL_FRAGMENT_SHADER, true,
      "#version 400\nuniform dvec2 number; uniform dmat2x3 more; out vec4 color; subroutine vec4 Tone();\n"
      "subroutine(Tone) vec4 red() { return vec4(1, 0, 0, 1); }\n"
      "subroutine(Tone) vec4 green() { return vec4(0, 1, 0, 1); }\n"
      "subroutine uniform Tone tone;\n"
      "void main() { color = number.y == 0.1lf && more[1].z == 6.0lf ? tone() : vec4(0, 0, 1, 1); }"}},
    {{0, "place"}},
    {}};

class StagesTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL";
        node_.node->tiles = {{0, {0, 0, 8, 8}}};
        open(SessionId(1));
    }
    void open(SessionId id) {
        session_.emplace(*node_.node, id);
        session_->open_surface(8, 8, {0, 0, 8, 8});
    }
    glapi::ProgramReflection link(const glapi::ProgramDefinition& definition) {
        Batch batch;
        pack::ProgramLink(batch.buffer(), RequestId(5), kProgram, encode(definition));
        session_->expect_run(batch);
        const auto reflection = glapi::decode_reflection(session_->replies[RequestId(5)]);
        EXPECT_TRUE(reflection && reflection->linked) << (reflection ? reflection->log : "no answer");
        return reflection.value_or(glapi::ProgramReflection());
    }
    static void square(wire::PackBuffer& b, GLenum mode) {
        pack::Clear(b, GL_COLOR_BUFFER_BIT);
        pack::Begin(b, mode);
        for (const auto& v :
             {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}})
            pack::Vertex2f(b, v[0], v[1]);
        pack::End(b);
    }
    Pixels drawn(GLenum mode, std::int32_t patch = 4) {
        Batch batch;
        batch.set<el::current_program>(kProgram.value).set<el::patch_vertices>(patch);
        batch.block(1, [&](auto& b) { square(b, mode); });
        session_->expect_run(batch);
        return session_->read(0, {3, 3, 1, 1});
    }
    void set_doubles(GLenum type, std::uint32_t location, const std::vector<double>& values) {
        Batch batch;
        pack::Uniform(batch.buffer(), kProgram, location, type, 1, std::as_bytes(std::span(values)));
        session_->expect_run(batch);
    }

    TestNode node_;
    std::optional<TestSession> session_;
};

TEST_F(StagesTest, PatchesAreTessellated) {
    const auto reflection = link(kTessellated);
    EXPECT_EQ(reflection.tessellation.mode, GLenum{GL_QUADS});
    EXPECT_EQ(reflection.tessellation.vertices, 0u) << "there is no control shader";
    EXPECT_EQ(reflection.tessellation.output(), GLenum{GL_TRIANGLES});
    EXPECT_FALSE(reflection.position.known());
    EXPECT_EQ(drawn(GL_PATCHES), kGreen);
}

TEST_F(StagesTest, WhatDoesNotFitTheStagesIsNotDrawn) {
    EXPECT_EQ(drawn(GL_PATCHES), kBlack) << "no program";
    link(kTessellated);
    EXPECT_EQ(drawn(GL_QUADS), kBlack);
    drawn(GL_PATCHES, 0);  // the driver keeps the size that it had
    drawn(GL_PATCHES, 0x7fffffff);
    Batch batch;
    batch.set<el::patch_outer_level>({-1, 1e30f, 0, 5}).set<el::patch_inner_level>({1e30f, -1e30f});
    session_->expect_run(batch);
    drawn(GL_PATCHES, 1);
    drawn(GL_PATCHES, 32);
    EXPECT_EQ(drawn(GL_PATCHES + 1), kBlack);
}

TEST_F(StagesTest, DoublesAndFunctions) {
    const auto reflection = link(kNumbers);
    ASSERT_EQ(reflection.uniforms.size(), 2u);
    const bool first = reflection.uniforms[0].name == "number";
    const glapi::ActiveUniform &number = reflection.uniforms[first ? 0 : 1], &more = reflection.uniforms[first ? 1 : 0];
    EXPECT_EQ(number.initial.size(), 4u);
    ASSERT_EQ(reflection.subroutines.size(), 1u);
    const glapi::SubroutineStage& stage = reflection.subroutines[0];
    EXPECT_EQ(stage.stage, GLenum{GL_FRAGMENT_SHADER});
    ASSERT_EQ(stage.functions.size(), 2u);
    ASSERT_EQ(stage.uniforms.size(), 1u);
    EXPECT_EQ(stage.uniforms[0].name, "tone");
    EXPECT_EQ(stage.uniforms[0].compatible.size(), 2u);
    ASSERT_EQ(stage.locations, 1u);
    set_doubles(GL_DOUBLE_VEC2, static_cast<std::uint32_t>(number.location), {0.2, 0.1});
    set_doubles(GL_DOUBLE_MAT2x3, static_cast<std::uint32_t>(more.location), {1, 2, 3, 4, 5, 6});
    for (std::uint32_t i = 0; i < 2; ++i) {
        Batch choose;
        pack::Subroutines(choose.buffer(), kProgram, GL_FRAGMENT_SHADER, std::as_bytes(std::span(&i, 1)));
        session_->expect_run(choose);
        EXPECT_EQ(drawn(GL_QUADS), stage.functions[i] == "red" ? kRed : kGreen) << i;
    }
    EXPECT_EQ(session_->session.work.gl_errors, 0u);
}

TEST_F(StagesTest, WhatNoClientSaysDoesNoHarm) {
    link(kNumbers);
    const auto choose = [&](GLenum stage, const std::vector<std::uint32_t>& indices) {
        Batch batch;
        pack::Subroutines(batch.buffer(), kProgram, stage, std::as_bytes(std::span(indices)));
        return session_->run(batch);
    };
    EXPECT_TRUE(choose(GL_VERTEX_SHADER, {1, 2, 3})) << "a stage without any";
    EXPECT_TRUE(choose(GL_RGBA, {1}));
    EXPECT_TRUE(choose(GL_FRAGMENT_SHADER, {0xffffffffu}));
    drawn(GL_QUADS);
    EXPECT_FALSE(choose(GL_FRAGMENT_SHADER, {0, 0}));
    open(SessionId(2));
    Batch other;
    pack::Subroutines(other.buffer(), kProgram, GL_FRAGMENT_SHADER, {});
    EXPECT_FALSE(session_->run(other)) << "no such program";
}

/// One for vertices and two for fragments.
class PipelineTest : public StagesTest {
protected:
    static constexpr ClientName kFirst{11}, kGreenOne{12}, kRedOne{13}, kPipeline{14};

    static glapi::ProgramDefinition separable(GLenum stage, const char* text) {
        glapi::ProgramDefinition definition{{{stage, true, text}}, {{0, "place"}}, {}};
        definition.separable = true;
        return definition;
    }
    void SetUp() override {
        StagesTest::SetUp();
        if (!node_.usable()) return;
        Batch batch;
        wire::PackBuffer& b = batch.buffer();
        pack::ProgramLink(b, RequestId(0), kFirst,
                          encode(separable(GL_VERTEX_SHADER,
                                           "#version 410\nin vec4 place; out gl_PerVertex { vec4 "
                                           "gl_Position; }; void main() { gl_Position = place; }")));
        pack::ProgramLink(b, RequestId(0), kGreenOne,
                          encode(separable(GL_FRAGMENT_SHADER,
                                           "#version 410\nout vec4 color; void main() { color = "
                                           "vec4(0, gl_FragCoord.x > 3.0, 0, 1); }")));
        pack::ProgramLink(
            b, RequestId(0), kRedOne,
            encode(separable(GL_FRAGMENT_SHADER,
                             "#version 410\nuniform float red; out vec4 color; void main() { color = vec4(red, 0, 0, "
                             "1); }")));
        const float one = 1;
        pack::Uniform(b, kRedOne, 0, GL_FLOAT, 1, std::as_bytes(std::span(&one, 1)));
        session_->expect_run(batch);
    }
    void define(ClientName vertex, ClientName fragment) {
        const std::array<std::uint32_t, std::size(glapi::kShaderStages)> programs{vertex.value, fragment.value};
        Batch batch;
        pack::Pipeline(batch.buffer(), kPipeline, std::as_bytes(std::span(programs)));
        session_->expect_run(batch);
    }
    Pixels drawn_with(ClientName program) {
        Batch batch;
        batch.set<el::current_program>(program.value).set<el::color>({1, 1, 1, 1});
        batch.block(1, [&](auto& b) { square(b, GL_QUADS); });
        session_->expect_run(batch);
        return session_->read(0, {4, 4, 1, 1});
    }
};

TEST_F(PipelineTest, ProgramsAreDrawnWithTogether) {
    define(kFirst, kGreenOne);
    EXPECT_EQ(drawn_with(kPipeline), kGreen);
    define(kFirst, kRedOne);
    EXPECT_EQ(drawn_with(kPipeline), kRed);
    EXPECT_EQ(session_->session.work.gl_errors, 0u);
    EXPECT_EQ(drawn_with(ClientName()), (Pixels{255, 255, 255, 255})) << "fixed function";
    EXPECT_EQ(drawn_with(kPipeline), kRed);
}

TEST_F(PipelineTest, WhatGoesMeanwhileDoesNoHarm) {
    define(kFirst, kGreenOne);
    EXPECT_EQ(drawn_with(kPipeline), kGreen);
    Batch gone;
    pack::ObjectDelete(gone.buffer(), kGreenOne);
    session_->expect_run(gone);
    drawn_with(kPipeline);
    link(kTessellated);
    define(kFirst, kProgram);
    drawn_with(kPipeline);  // it is not separable
    define(ClientName(99), kPipeline);
    drawn_with(kPipeline);
    define(kFirst, kRedOne);
    EXPECT_EQ(drawn_with(kPipeline), kRed);
    Batch over;
    pack::ObjectDelete(over.buffer(), kPipeline);
    session_->expect_run(over);
    EXPECT_EQ(drawn_with(kPipeline), (Pixels{255, 255, 255, 255}));
    Batch bad;
    pack::Pipeline(bad.buffer(), kPipeline, {});
    EXPECT_FALSE(session_->run(bad));
}

TEST_F(StagesTest, AShaderChoosesAViewport) {
    link({{{GL_VERTEX_SHADER, true, kVertex},
           {GL_GEOMETRY_SHADER, true,
            "#version 410\nlayout(triangles) in; layout(triangle_strip, max_vertices = 3) out; void main() {\n"
            "  for (int i = 0; i < 3; ++i) { gl_ViewportIndex = 2; gl_Position = gl_in[i].gl_Position; EmitVertex(); } "
            "}"},
           {GL_FRAGMENT_SHADER, true, "#version 400\nout vec4 color; void main() { color = vec4(0, 1, 0, 1); }"}},
          {{0, "place"}},
          {}});
    const auto at = [&](std::int32_t x) { return session_->read(0, {x, 3, 1, 1}); };
    drawn(GL_TRIANGLE_FAN);
    EXPECT_EQ(at(1), kGreen) << "all are alike";
    Batch batch;
    batch.set<el::viewport_rest>({4, 0, 4, 8}, 1);
    session_->expect_run(batch);
    drawn(GL_TRIANGLE_FAN);
    EXPECT_EQ(at(1), kBlack);
    EXPECT_EQ(at(6), kGreen);
    Batch cut;
    cut.set<el::scissor_enabled>(4).set<el::scissor_rest>({0, 0, 5, 8}, 1);
    cut.set<el::depth_range_rest>({0.5, 0.25}, 1).set<el::viewport_rest>({-1e30f, 0, 1e30f, -5}, 9);
    session_->expect_run(cut);
    Batch clear;
    clear.set<el::scissor_enabled>(0);
    session_->expect_run(clear);
    drawn(GL_TRIANGLE_FAN);
    EXPECT_EQ(at(6), kGreen);
}

TEST_F(StagesTest, EachDrawBufferBlendsItsOwnWay) {
    Batch batch;
    batch.set<el::blend_enabled>(0xff).set<el::color>({0, 1, 0, 1}).set<el::clear_color>({1, 0, 0, 1});
    batch.set<el::blend_func_rest>({GL_ZERO, GL_ONE, GL_ZERO, GL_ONE}, 0);
    batch.set<el::blend_func>({GL_ONE, GL_ZERO, GL_ONE, GL_ZERO});
    batch.block(1, [](auto& b) { square(b, GL_QUADS); });
    session_->expect_run(batch);
    EXPECT_EQ(session_->read(0, {3, 3, 1, 1}), kGreen) << "the first one's";
    Batch other;
    other.set<el::blend_func>({GL_ZERO, GL_ONE, GL_ZERO, GL_ONE});
    other.set<el::blend_equation_rest>({7, 7}, 6).set<el::blend_func_rest>({1, 2, 3, 4}, 3);
    other.block(1, [](auto& b) { square(b, GL_QUADS); });
    session_->expect_run(other);
    EXPECT_EQ(session_->read(0, {3, 3, 1, 1}), kRed);
}

}  // namespace
}  // namespace wall::tileserver
