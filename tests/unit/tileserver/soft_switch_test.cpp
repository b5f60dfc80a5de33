// SPDX-License-Identifier: MIT
// The soft context switch: whatever happened before, the driver holds what the context wants.
#include "tileserver/session/soft_switch.h"

#include <gtest/gtest.h>

#include <array>
#include <iterator>
#include <optional>
#include <random>
#include <span>

#include "common/glapi/program_format.h"
#include "gen/glstate/samples.gen.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

constexpr int kWidth = 64, kHeight = 48;

class SoftSwitch : public ::testing::Test {
protected:
    explicit SoftSwitch(void (*change)(Gl& gl) = nullptr) : node_("egl", change) {}
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL";
        node_.node->tiles = {{0, {0, 0, kWidth, kHeight}}};
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(kWidth, kHeight, {0, 0, kWidth, kHeight});
        for (const std::size_t i : {1, 2})  // all draw to the same window
            context(i).state = context(0).state;
    }
    SoftContext& context(std::size_t i) {
        return session_->session.context(ContextId(static_cast<std::uint32_t>(i + 1)));
    }
    bool switch_to_context(std::size_t i) {
        RenderTarget& target = *session_->session.surface(SurfaceId(1))->layer(0);
        return switch_to(*node_.node, session_->session, context(i), target, {true, true});
    }
    /// What glGetFloatv says of the current colour and of the fog's.
    std::array<glstate::Vec4, 2> held() const {
        std::array<glstate::Vec4, 2> values{};
        node_.driver->gl().GetFloatv(GL_CURRENT_COLOR, values[0].data());
        node_.driver->gl().GetFloatv(GL_FOG_COLOR, values[1].data());
        return values;
    }
    std::array<glstate::Vec4, 2> wanted(std::size_t i) {
        const glstate::State& state = context(i).state;
        return {el::color::ref(state), el::fog_color::ref(state)};
    }
    Driver& driver() { return *node_.driver; }

    TestNode node_;
    std::optional<TestSession> session_;
};

TEST_F(SoftSwitch, OfContextsAsTheyBeginIsHeldFromTheFirstOn) {
    for (std::size_t turn = 0; turn < 4; ++turn) {
        EXPECT_EQ(driver().holds(context(turn % 2).state), turn > 0) << turn;
        ASSERT_TRUE(switch_to_context(turn % 2));
    }
}

TEST_F(SoftSwitch, OfEqualContextsIsHeldAfterOneTurn) {
    for (std::size_t i : {0, 1}) glstate::assign<el::fog_color>(context(i).state, 0, {0.25f, 0.5f, 0.75f, 1});
    for (std::size_t turn = 0; turn < 4; ++turn) {
        EXPECT_EQ(driver().holds(context(turn % 2).state), turn > 1) << turn;
        ASSERT_TRUE(switch_to_context(turn % 2));
    }
}

TEST_F(SoftSwitch, AValueThatOneContextHasSetIsToldAndTakenBack) {
    glstate::assign<el::fog_color>(context(1).state, 0, {0.25f, 0.5f, 0.75f, 1});
    for (std::size_t turn = 0; turn < 4; ++turn) {
        ASSERT_TRUE(switch_to_context(turn % 2));
        EXPECT_EQ(held(), wanted(turn % 2)) << turn;
    }
}

TEST_F(SoftSwitch, WhatDrawingLeftInTheDriverIsSeen) {
    ASSERT_TRUE(switch_to_context(0));
    ASSERT_TRUE(switch_to_context(0));
    driver().gl().Color4f(0.5f, 0.25f, 0, 1);  // as of a vertex of a block, whose trail is folded into the mirror
    glstate::assign<el::color>(driver().mirror, 0, {0.5f, 0.25f, 0, 1});
    ASSERT_TRUE(switch_to_context(0));
    EXPECT_EQ(held(), wanted(0));
}

TEST_F(SoftSwitch, ACopiedStateIsThatOfItsOriginal) {
    glstate::assign<el::fog_color>(context(0).state, 0, {1, 0.5f, 0.25f, 0});
    ASSERT_TRUE(switch_to_context(0));
    ASSERT_TRUE(switch_to_context(1));
    context(1).state = context(0).state;
    ASSERT_TRUE(switch_to_context(1));
    EXPECT_EQ(held(), wanted(1));
}

TEST_F(SoftSwitch, HoldsAfterAnyHistory) {
    std::mt19937 random(1);
    const auto below = [&](unsigned n) { return static_cast<unsigned>(random()) % n; };
    for (unsigned step = 0; step < 2000; ++step) {
        const unsigned who = below(3);
        glstate::State& state = context(who).state;
        switch (below(6)) {
            case 0: glstate::assign<el::color>(state, 0, glstate::Samples<el::color>::values[below(3)]); break;
            case 1: glstate::assign<el::fog_color>(state, 0, glstate::Samples<el::fog_color>::values[below(3)]); break;
            case 2: state = context(below(3)).state; break;
            case 3:  // only who knows that they are equal says so
                if (glstate::same(state.current, driver().mirror.current) &&
                    glstate::same(state.material, driver().mirror.material))
                    driver().unify_attributes(state);
                break;
            case 4: {
                const glstate::Vec4 color = glstate::Samples<el::color>::values[below(3)];
                driver().gl().Color4fv(color.data());
                glstate::assign<el::color>(driver().mirror, 0, color);
                break;
            }
            default: break;
        }
        const unsigned next = below(3);
        ASSERT_TRUE(switch_to_context(next));
        ASSERT_EQ(held(), wanted(next)) << step;
    }
}

// ---- a driver that has the colour and the generic attribute 3 at one place ----

constexpr GLuint kPlace = 3;
glapi::GlFunctions real;  // of the driver below it

void GLAPIENTRY set_color(GLfloat x, GLfloat y, GLfloat z, GLfloat w) {
    real.Color4f(x, y, z, w);
    real.VertexAttrib4f(kPlace, x, y, z, w);
}
void GLAPIENTRY set_attribute(GLuint index, GLfloat x, GLfloat y, GLfloat z, GLfloat w) {
    real.VertexAttrib4f(index, x, y, z, w);
    if (index == kPlace) real.Color4f(x, y, z, w);
}
void GLAPIENTRY set_attribute_of(GLuint index, const GLfloat* v) { set_attribute(index, v[0], v[1], v[2], v[3]); }

void keep_attributes_together(Gl& gl) {
    real = gl;
    gl.Color4f = set_color;
    gl.VertexAttrib4f = set_attribute;
    gl.VertexAttrib4fv = set_attribute_of;
}

class OfAttributesAtOnePlace : public SoftSwitch {
protected:
    static constexpr ClientName kProgram{7};
    static constexpr glstate::Vec4 kRed{1, 0, 0, 1}, kGreen{0, 1, 0, 1};

    OfAttributesAtOnePlace() : SoftSwitch(keep_attributes_together) {}
    void SetUp() override {
        SoftSwitch::SetUp();
        if (IsSkipped()) return;
        glapi::ProgramDefinition definition;
        definition.shaders.push_back({.type = GL_VERTEX_SHADER,
                                      .compiled = true,
                                      .source = "attribute vec4 tint;\n"
                                                "void main() { gl_Position = gl_Vertex; gl_FrontColor = tint; }"});
        definition.attributes.push_back({kPlace, "tint"});
        Batch batch;
        pack::ProgramLink(batch.buffer(), RequestId(1), kProgram, encode(definition));
        session_->expect_run(batch);
        glstate::assign<el::color>(context(0).state, 0, kRed);
        glstate::assign<el::vertex_attrib>(context(1).state, kPlace, kGreen);
    }
    /// Of what the next vertex has at that place.
    glstate::Vec4 at_place() const { return held()[0]; }
};

TEST_F(OfAttributesAtOnePlace, FixedFunctionHasItsOwn) {
    for (int turn = 0; turn < 2; ++turn) {
        ASSERT_TRUE(switch_to_context(0));
        EXPECT_EQ(at_place(), kRed) << turn;
        ASSERT_TRUE(switch_to_context(1));
        EXPECT_EQ(at_place(), (glstate::Vec4{1, 1, 1, 1})) << turn;
    }
}

TEST_F(OfAttributesAtOnePlace, AProgramHasTheGenericOnesThatItReads) {
    glstate::assign<el::current_program>(context(1).state, 0, kProgram.value);
    for (int turn = 0; turn < 2; ++turn) {
        ASSERT_TRUE(switch_to_context(0));
        EXPECT_EQ(at_place(), kRed) << turn;
        ASSERT_TRUE(switch_to_context(1));
        EXPECT_EQ(at_place(), kGreen) << turn;
    }
    context(0).state = context(1).state;
    glstate::assign<el::current_program>(context(0).state, 0, 0);
    ASSERT_TRUE(switch_to_context(0));
    EXPECT_EQ(at_place(), (glstate::Vec4{1, 1, 1, 1})) << "no value but the program has changed";
    ASSERT_TRUE(switch_to_context(1));
    EXPECT_EQ(at_place(), kGreen);
}

TEST_F(OfAttributesAtOnePlace, APipelineHasThoseOfTheProgramsThatItHasNow) {
    constexpr ClientName kPipeline{8}, kPart{9};
    glapi::ProgramDefinition definition;
    definition.separable = true;
    definition.shaders.push_back({.type = GL_VERTEX_SHADER,
                                  .compiled = true,
                                  .source = "#version 410\nin vec4 tint; out vec4 shade; out gl_PerVertex { vec4 "
                                            "gl_Position; }; void main() { gl_Position = vec4(0); shade = tint; }"});
    definition.attributes.push_back({kPlace, "tint"});
    const auto define = [&](ClientName vertex) {
        const std::array<std::uint32_t, std::size(glapi::kShaderStages)> programs{vertex.value};
        Batch batch;
        pack::ProgramLink(batch.buffer(), RequestId(2), kPart, encode(definition));
        pack::Pipeline(batch.buffer(), kPipeline, std::as_bytes(std::span(programs)));
        session_->expect_run(batch);
    };
    glstate::assign<el::current_program>(context(1).state, 0, kPipeline.value);
    define({});
    for (int turn = 0; turn < 2; ++turn) ASSERT_TRUE(switch_to_context(1));
    EXPECT_EQ(at_place(), (glstate::Vec4{1, 1, 1, 1}));
    define(kPart);
    ASSERT_TRUE(switch_to_context(1));
    EXPECT_EQ(at_place(), kGreen) << "of the same context, whose state has not changed";
}

TEST_F(OfAttributesAtOnePlace, WhatDrawingLeftInTheDriverIsSeen) {
    ASSERT_TRUE(switch_to_context(0));
    driver().gl().VertexAttrib4f(kPlace, 0, 1, 0, 1);
    glstate::assign<el::vertex_attrib>(driver().mirror, kPlace, kGreen);
    ASSERT_TRUE(switch_to_context(0));
    EXPECT_EQ(at_place(), kRed);
}

}  // namespace
}  // namespace wall::tileserver::test
