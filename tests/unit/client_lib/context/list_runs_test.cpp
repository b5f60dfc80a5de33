// SPDX-License-Identifier: MIT
// What calling a display list leaves in the current values, in the context and in the driver of a node that ran it. The
// context's are what Mesa 22.3 leaves (tests/golden/programs/list_arrays.cpp shows that they are).
#include "client_lib/context/lists.h"
#include "client_lib/geometry/block_walk.h"
#include "client_lib/objects/program.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

constexpr glstate::Vec4 kBefore{0.125f, 0.25f, 0.5f, 1}, kLast{0, 1, 0, 1}, kYellow{1, 1, 0, 1};

class ListRunTest : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        gl().VertexPointer(c, 2, GL_FLOAT, 0, kPlaces);
        gl().ColorPointer(c, 3, GL_FLOAT, 0, kColors);
        gl().NormalPointer(c, GL_FLOAT, 0, kColors);
        gl().EnableClientState(c, GL_VERTEX_ARRAY);
        gl().EnableClientState(c, GL_COLOR_ARRAY);
        gl().EnableClientState(c, GL_NORMAL_ARRAY);
    }
    template <class Body>
    const DisplayList& compile(Body&& body) {
        gl().NewList(c, 1, GL_COMPILE);
        body();
        gl().EndList(c);
        return *share->lists.find(1);
    }
    /// The current colour behind a call.
    glstate::Vec4 colour_after_call() {
        gl().Color4f(c, kBefore[0], kBefore[1], kBefore[2], kBefore[3]);
        gl().Normal3f(c, 0, 0, 1);
        gl().CallList(c, 1);
        c.flush_block();
        return c.state.current.color;
    }
    void arrays() { gl().DrawArrays(c, GL_TRIANGLES, 0, 3); }
    void bare() {
        gl().Begin(c, GL_TRIANGLES);
        for (int i = 0; i < 3; ++i) gl().Vertex2f(c, kPlaces[2 * i], kPlaces[2 * i + 1]);
        gl().End(c);
    }
    void yellow() {
        gl().Begin(c, GL_TRIANGLES);
        gl().Color3f(c, 1, 1, 0);
        for (int i = 0; i < 3; ++i) gl().Vertex2f(c, kPlaces[2 * i], kPlaces[2 * i + 1]);
        gl().End(c);
    }

    static constexpr GLfloat kPlaces[] = {0, 0, 1, 0, 1, 1};
    static constexpr GLfloat kColors[] = {1, 0, 0, 1, 0, 0, 0, 1, 0};
};

TEST_F(ListRunTest, ArraysLeaveTheCurrentValuesOfTheContextButNotOfTheDriver) {
    const auto& list = compile([&] { arrays(); });
    ASSERT_EQ(list.items.size(), 1u);
    EXPECT_EQ(list.items[0].run->in_driver.attributes.size(), 2u);
    EXPECT_TRUE(list.items[0].run->in_context.attributes.empty());
    EXPECT_EQ(colour_after_call(), kBefore);
    EXPECT_EQ(c.state.current.normal, (glstate::Vec3{0, 0, 1}));
}

TEST_F(ListRunTest, ALastPrimitiveOfVerticesLeavesWhatArraysOfItsGroupSet) {
    const auto& list = compile([&] { arrays(), bare(); });
    EXPECT_EQ(list.items.size(), 1u);  // its vertices have the last element's colour
    EXPECT_EQ(colour_after_call(), kLast);
    EXPECT_EQ(c.state.current.normal, (glstate::Vec3{0, 1, 0}));
}

TEST_F(ListRunTest, LastArraysMakeTheContextForgetTheirGroup) {
    compile([&] { yellow(), arrays(); });
    EXPECT_EQ(colour_after_call(), kBefore);
    compile([&] { arrays(), bare(), arrays(); });
    EXPECT_EQ(colour_after_call(), kBefore);
    compile([&] { yellow(), gl().Normal3f(c, 0, -1, 0), arrays(); });  // another group
    EXPECT_EQ(colour_after_call(), kYellow);
    EXPECT_EQ(c.state.current.normal, (glstate::Vec3{0, -1, 0}));
}

TEST_F(ListRunTest, MaterialsOfSuchAGroupAreForgottenToo) {
    const GLfloat red[] = {1, 0, 0, 1};
    const auto in_vertices = [&] {
        gl().Begin(c, GL_POINTS);
        gl().Materialfv(c, GL_FRONT, GL_DIFFUSE, red);
        gl().Vertex2f(c, 0, 0);
        gl().End(c);
    };
    const auto& list = compile([&] { in_vertices(), arrays(); });
    EXPECT_EQ(list.items[0].run->in_driver.materials.size(), 1u);
    gl().CallList(c, 1);
    EXPECT_EQ(c.state.material.material_diffuse[0][1], 0.8f);
    compile([&] { in_vertices(); });
    gl().CallList(c, 1);
    EXPECT_EQ(c.state.material.material_diffuse[0][1], 0.0f);
}

TEST_F(ListRunTest, ARunEndsWhereAVertexWouldSeeForgottenValues) {
    // The normal is the array's last in a driver, the program's own for the program.
    const auto& cut = compile([&] { arrays(), gl().Color3f(c, 1, 1, 0), bare(); });
    ASSERT_EQ(cut.items.size(), 2u);
    EXPECT_TRUE(cut.items[0].run && cut.items[1].run);
    EXPECT_EQ(colour_after_call(), kYellow);
    EXPECT_EQ(c.state.current.normal, (glstate::Vec3{0, 0, 1}));
}

TEST_F(ListRunTest, ARunGoesOnWhereVerticesSetTheirOwnValues) {
    const auto& whole = compile([&] {
        for (int i = 0; i < 5; ++i) {
            gl().Color3f(c, 1, 1, 0);
            arrays();
        }
        gl().Color3f(c, 1, 1, 0);
    });
    EXPECT_EQ(whole.items.size(), 1u);
    EXPECT_EQ(whole.items[0].run->array_draws.size(), 5u);
    EXPECT_EQ(colour_after_call(), kYellow);
}

TEST_F(ListRunTest, WhatIsSetBehindTheLastVertexComesBehindEnd) {
    const auto& list = compile([&] {
        gl().Begin(c, GL_POINTS);
        gl().Color3f(c, 1, 0, 0);
        gl().Vertex2f(c, 0, 0);
        gl().Color3f(c, 1, 1, 0);
        gl().TexCoord2f(c, 1, 2);
        gl().End(c);
        yellow();
    });
    const auto& content = list.items[0].run->content;
    std::vector<glapi::Op> order;
    for (std::size_t i = 0; i < 6; ++i) order.push_back(static_cast<glapi::Op>(content.opcode_at(i)));
    using glapi::Op;
    EXPECT_EQ(order, (std::vector{Op::Begin, Op::Color3f, Op::Vertex2f, Op::End, Op::Color3f, Op::TexCoord2f}));
    EXPECT_EQ(colour_after_call(), kYellow);
    EXPECT_EQ(c.state.current.texcoord[0], (glstate::Vec4{1, 2, 0, 1}));
}

TEST_F(ListRunTest, EveryPartOfArraysWithARestartIsMarked) {
    const GLubyte indices[] = {0, 1, 2, 255, 0, 1, 2};
    c.state.local.primitive_restart = 1;
    c.state.local.primitive_restart_index = 255;
    const auto& list = compile([&] { gl().DrawElements(c, GL_TRIANGLES, 7, GL_UNSIGNED_BYTE, indices); });
    EXPECT_EQ(list.items[0].run->array_draws.size(), 2u);
    EXPECT_EQ(colour_after_call(), kBefore);
}

TEST_F(ListRunTest, AttributesBeforeTheFirstVertexNeedNotBeBroughtUpToDate) {
    const auto& list = compile([&] { arrays(); });
    const std::uint32_t spared = list.items[0].run->spared;
    EXPECT_TRUE(spared >> static_cast<unsigned>(Attribute::color) & 1);
    EXPECT_TRUE(spared >> static_cast<unsigned>(Attribute::normal) & 1);
    EXPECT_FALSE(spared >> static_cast<unsigned>(Attribute::texcoord) & 1);
}

TEST_F(ListRunTest, TheBoxIsTheSameWhetherAProgramIsUsedOrNot) {
    c.program = std::make_shared<Program>(ClientName(1), 1);
    const auto& list = compile([&] { bare(); });
    ASSERT_TRUE(list.items[0].run);
    EXPECT_FALSE(list.items[0].run->box.unbounded());
    EXPECT_EQ(c.program->id, ClientName(1));
    c.program.reset();
}

}  // namespace
}  // namespace wall::client
