// SPDX-License-Identifier: MIT
#include "client_lib/packer.h"

#include <gtest/gtest.h>

#include "client_lib/context.h"
#include "client_lib/primitive_scan.h"

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
    const auto vertices = scan_vertices(packer, primitive, Projection{});
    ASSERT_EQ(vertices.size(), static_cast<std::size_t>(kMany));
    const auto color = primitive.after.offset[static_cast<std::size_t>(Attribute::color)];
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
    Packer packer;
    tls_packer = &packer;
    gl_entry_Color3f(0.5f, 0, 0);
    packer.begin(GL_TRIANGLES);
    for (int i = 0; i < 3; ++i) {
        if (i == 1) gl_entry_Color3f(1, 0, 0);
        gl_entry_Vertex3f(static_cast<float>(i), 0, 0);
    }
    packer.end();
    tls_packer = nullptr;
    const auto vertices = scan_vertices(packer, packer.primitives()[0], Projection{});
    ASSERT_EQ(vertices.size(), 3u);
    const auto red_at = [&](const AttributePlaces& places) {
        float red;
        std::memcpy(&red, packer.operand_at(places.offset[static_cast<std::size_t>(Attribute::color)]), sizeof red);
        return red;
    };
    EXPECT_EQ(red_at(vertices[0].at), 0.5f);
    EXPECT_EQ(red_at(vertices[1].before), 0.5f);
    EXPECT_EQ(red_at(vertices[1].at), 1.0f);
    EXPECT_EQ(red_at(vertices[2].before), 1.0f);
}

}  // namespace
}  // namespace wall::client
