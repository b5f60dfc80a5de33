// SPDX-License-Identifier: MIT
#include "client_lib/geometry/packer.h"

#include <gtest/gtest.h>

#include <cstring>

#include "client_lib/context/context.h"
#include "client_lib/geometry/primitive_scan.h"
#include "client_lib/objects/share_group.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {

void GLAPIENTRY gl_entry_Vertex3f(GLfloat x, GLfloat y, GLfloat z);
void GLAPIENTRY gl_entry_Color3f(GLfloat r, GLfloat g, GLfloat b);
void GLAPIENTRY gl_entry_Normal3f(GLfloat x, GLfloat y, GLfloat z);

namespace {

class PackerTest : public testing::Test {
protected:
    void SetUp() override { tls_packer = &packer; }
    void TearDown() override { tls_packer = nullptr; }
    Packer packer;
};

TEST_F(PackerTest, AVertexCostsThirteenBytes) {
    packer.begin(GL_TRIANGLES);
    const auto before = packer.bytes();
    gl_entry_Vertex3f(1, 2, 3);
    EXPECT_EQ(packer.bytes() - before, 13u);
}

TEST_F(PackerTest, KeepsTheBoxOfEachPrimitive) {
    packer.begin(GL_LINES);
    gl_entry_Vertex3f(1, -2, 3);
    gl_entry_Vertex3f(-4, 5, 0);
    packer.end();
    packer.begin(GL_POINTS);
    gl_entry_Vertex3f(9, 9, 9);
    packer.end();
    ASSERT_EQ(packer.primitives().size(), 2u);
    alignas(16) float lo[4], hi[4];
    _mm_store_ps(lo, packer.primitives()[0].box.min);
    _mm_store_ps(hi, packer.primitives()[0].box.max);
    EXPECT_EQ(lo[0], -4);
    EXPECT_EQ(lo[1], -2);
    EXPECT_EQ(lo[2], 0);
    EXPECT_EQ(hi[0], 1);
    EXPECT_EQ(hi[1], 5);
    EXPECT_EQ(hi[2], 3);
}

TEST_F(PackerTest, APrimitiveThatCannotBeCarriedIsDroppedAlone) {
    packer.set_most_bytes(1 << 20);
    const auto points = [&](int count) {
        packer.begin(GL_POINTS);
        gl_entry_Color3f(static_cast<float>(count), 0, 0);
        for (int i = 0; i < count; ++i) {
            if (packer.next_operand() >= packer.limit) packer.make_room();
            gl_entry_Vertex3f(static_cast<float>(i), 0, 0);
        }
        packer.end();
    };
    points(10);
    const auto mark = packer.mark();
    EXPECT_FALSE(packer.take_overflow());
    points(1'000'000);
    EXPECT_TRUE(packer.take_overflow());
    EXPECT_FALSE(packer.take_overflow()) << "it is said once";
    EXPECT_EQ(packer.mark().commands, mark.commands);
    EXPECT_EQ(packer.mark().operand_bytes, mark.operand_bytes);
    const std::byte* color = packer.last[place_of(Attribute::color)];
    ASSERT_NE(color, nullptr);
    float red = 0;
    std::memcpy(&red, color, sizeof red);
    EXPECT_EQ(red, 10) << "the colour of before";
    points(10);
    EXPECT_FALSE(packer.take_overflow());
    EXPECT_EQ(packer.primitives().size(), 2u);
    EXPECT_LT(packer.bytes(), 1000u);
}

TEST_F(PackerTest, GrowsBeyondItsFirstRoomWithoutLosingAnything) {
    packer.begin(GL_POINTS);
    constexpr int kMany = 100000;
    for (int i = 0; i < kMany; ++i) {
        if (packer.next_operand() >= packer.limit) packer.make_room();
        gl_entry_Color3f(static_cast<float>(i), 0, 0);
        if (packer.next_operand() >= packer.limit) packer.make_room();
        gl_entry_Vertex3f(static_cast<float>(i), 0, 0);
    }
    packer.end();
    const auto& primitive = packer.primitives().at(0);
    VertexScan vertices;
    vertices.scan(packer, primitive, {}, glstate::Projection{});
    ASSERT_EQ(vertices.size(), static_cast<std::size_t>(kMany));
    const auto color = vertices.attributes(vertices.size()).offset[place_of(Attribute::color)];
    float last;
    std::memcpy(&last, packer.operand_at(color), sizeof last);
    EXPECT_EQ(last, static_cast<float>(kMany - 1));
}

TEST_F(PackerTest, AClosedPackerTakesNothing) {
    packer.set_closed(true);
    gl_entry_Vertex3f(1, 2, 3);
    gl_entry_Normal3f(0, 0, 1);
    EXPECT_TRUE(packer.empty());
}

TEST_F(PackerTest, APrimitiveWithoutVerticesIsNoGeometryButKeepsItsAttributes) {
    packer.begin(GL_QUADS);
    gl_entry_Color3f(1, 0, 0);
    packer.end();
    EXPECT_FALSE(packer.has_geometry());
    EXPECT_NE(packer.last[static_cast<std::size_t>(Attribute::color)], nullptr);
}

TEST(PrimitiveScan, KnowsTheAttributesOfEachVertex) {
    constexpr int kVertices = 30;  // of which the third, sixth ... have another colour
    Packer packer;
    tls_packer = &packer;
    gl_entry_Color3f(0.5f, 0, 0);
    packer.begin(GL_TRIANGLES);
    for (int i = 0; i < kVertices; ++i) {
        if (i % 3 == 2) gl_entry_Color3f(static_cast<float>(i), 0, 0);
        gl_entry_Vertex3f(static_cast<float>(i), 0, 0);
    }
    packer.end();
    tls_packer = nullptr;
    VertexScan vertices;
    BlockWalk walk(packer, {}, packer.mark(), {});
    walk.go_to(packer.primitives()[0].first);
    vertices.scan(packer, packer.primitives()[0], walk.places(), glstate::Projection{});
    ASSERT_EQ(vertices.size(), std::size_t{kVertices});
    const auto red_at = [&](std::size_t v) {
        float red;
        std::memcpy(&red, packer.operand_at(vertices.attributes(v).offset[place_of(Attribute::color)]), sizeof red);
        return red;
    };
    EXPECT_EQ(red_at(0), 0.5f);
    EXPECT_EQ(red_at(2), 0.5f);
    for (int i = 3; i <= kVertices; ++i)
        EXPECT_EQ(red_at(static_cast<std::size_t>(i)), static_cast<float>(i / 3 * 3 - 1));
}

TEST(PrimitiveScan, TextureUnitsAndGenericAttributesAreRememberedLikeAllOthers) {
    Context c(std::make_shared<ShareGroup>());
    const GlTable& gl = *c.table;
    gl.MultiTexCoord4f(c, GL_TEXTURE3, 1, 2, 3, 4);
    gl.Begin(c, GL_TRIANGLES);
    for (int i = 0; i < 3; ++i) {
        gl.VertexAttrib4f(c, 5, static_cast<float>(i), 0, 0, 1);
        gl.Indexf(c, 7);
        gl.Vertex2f(c, 0, 0);
    }
    gl.End(c);
    EXPECT_FALSE(c.packer.has_rare());
    EXPECT_TRUE(c.packer.primitives()[0].divisible);
    VertexScan vertices;
    BlockWalk walk(c.packer, {}, c.packer.mark(), {});
    walk.go_to(c.packer.primitives()[0].first);
    vertices.scan(c.packer, c.packer.primitives()[0], walk.places(), glstate::Projection{});
    const auto places = vertices.attributes(3);
    EXPECT_EQ(places.op[place_of(Attribute::texcoord + 3)], glapi::Op::MultiTexCoord4f);
    EXPECT_EQ(places.op[place_of(Attribute::color_index)], glapi::Op::Indexf);
    float x;
    std::memcpy(&x, c.packer.operand_at(places.offset[place_of(Attribute::vertex_attrib + 5)]) + 4, sizeof x);
    EXPECT_EQ(x, 2);
    EXPECT_EQ(places.offset[place_of(Attribute::vertex_attrib + 4)], AttributePlaces::kNone);
    c.packer.reset();
}

using ALargeDraw = ContextTest;

TEST_F(ALargeDraw, IsAnErrorAndTheNextOneIsPacked) {
    c.packer.set_most_bytes(1000);
    const auto points = [&](int count) {
        gl().Begin(c, GL_POINTS);
        for (int i = 0; i < count; ++i) gl().Vertex2f(c, 0, 0);
        gl().End(c);
    };
    points(10);
    EXPECT_EQ(gl().GetError(c), GLenum{GL_NO_ERROR});
    testing::internal::CaptureStderr();
    points(100);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("it was left out"), std::string::npos);
    EXPECT_EQ(gl().GetError(c), GLenum{GL_OUT_OF_MEMORY});
    EXPECT_EQ(gl().GetError(c), GLenum{GL_NO_ERROR});
    points(10);
    EXPECT_EQ(gl().GetError(c), GLenum{GL_NO_ERROR});
    EXPECT_EQ(c.packer.primitives().size(), 2u);
    c.packer.reset();
}

TEST(Attributes, EveryValueCanBeWrittenAndSetAgain) {
    glstate::State given;
    for (std::size_t i = 0; i < given.current.texcoord.size(); ++i) given.current.texcoord[i] = {1, 2, 3, float(i)};
    for (std::size_t i = 0; i < given.current.vertex_attrib.size(); ++i)
        given.current.vertex_attrib[i] = {4, 5, 6, float(i)};
    given.current.color = {0.1f, 0.2f, 0.3f, 0.4f};
    given.current.normal = {7, 8, 9};
    given.current.secondary_color = {0.5f, 0.6f, 0.7f, 1};
    given.current.fog_coord = 10;
    given.current.edge_flag = 0;
    given.current.color_index = 11;
    glstate::State made;
    for (unsigned i = 0; i < kAttributes; ++i) {
        std::array<std::byte, glstate::kMostAttributeBytes> operand{};
        const auto op = glstate::write_attribute(given, Attribute{} + i, operand.data());
        EXPECT_EQ(place_of(glstate::attribute_set_by(op, operand.data())), i);
        glstate::apply_attribute(made, op, operand.data());
    }
    EXPECT_TRUE(glstate::same(given.current, made.current));
}

}  // namespace
}  // namespace wall::client
