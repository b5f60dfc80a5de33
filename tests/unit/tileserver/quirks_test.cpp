// SPDX-License-Identifier: MIT
// Drivers that do otherwise than OpenGL says, as far as no test of what they would spoil has them (soft_switch_test).
#include "tileserver/driver/quirks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

using ::testing::ElementsAre;

TEST(Quirks, OfMesaAreNone) {
    const TestNode node;
    if (!node.usable()) GTEST_SKIP() << "no EGL";
    const Quirks quirks = try_out(node.driver->gl());
    EXPECT_FALSE(quirks.keeps_attributes_together);
    EXPECT_FALSE(quirks.loses_writes);
    std::array<GLfloat, 4> color{}, attribute{};
    node.driver->gl().GetFloatv(GL_CURRENT_COLOR, color.data());
    node.driver->gl().GetVertexAttribfv(3, GL_CURRENT_VERTEX_ATTRIB, attribute.data());
    EXPECT_THAT(color, ElementsAre(1, 1, 1, 1)) << "as they came";
    EXPECT_THAT(attribute, ElementsAre(0, 0, 0, 1));
}

// ---- a driver that clears a buffer behind what is written to it ----

void GLAPIENTRY lose(GLuint, GLintptr, GLsizeiptr, const void*) {}

void lose_writes(Gl& gl) { gl.NamedBufferSubData = lose; }

TEST(ADriverThatLosesWrites, IsMadeToCopyThem) {
    const TestNode node("egl", lose_writes);
    if (!node.usable()) GTEST_SKIP() << "no EGL";
    EXPECT_TRUE(try_out(node.driver->gl()).loses_writes);
    TestSession session(*node.node, SessionId(1));
    const std::array<std::byte, 3> content{std::byte{1}, std::byte{2}, std::byte{3}};
    Batch batch;
    pack::BufferData(batch.buffer(), ClientName(1), 5, GL_STATIC_DRAW);
    pack::BufferSubData(batch.buffer(), ClientName(1), 1, content);
    pack::BufferRead(batch.buffer(), RequestId(1), ClientName(1), 0, 5);
    session.expect_run(batch);
    EXPECT_THAT(session.replies[RequestId(1)],
                ElementsAre(std::byte{0}, std::byte{1}, std::byte{2}, std::byte{3}, std::byte{0}));
    EXPECT_EQ(session.session.work.gl_errors, 0u);
}

}  // namespace
}  // namespace wall::tileserver::test
