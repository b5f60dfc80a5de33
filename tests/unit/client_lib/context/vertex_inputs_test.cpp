// SPDX-License-Identifier: MIT
// Which name a context's arrays have among the nodes.
#include "client_lib/context/vertex_inputs.h"

#include "client_lib/context/buffer_binding.h"
#include "client_lib/context/forget_objects.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class VertexInputsTest : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        gl().GenBuffers(c, 2, names);
        for (const GLuint name : names) {
            gl().BindBuffer(c, GL_ARRAY_BUFFER, name);
            gl().BufferData(c, GL_ARRAY_BUFFER, 1200, nullptr, GL_STATIC_DRAW);
        }
    }
    void positions_at(GLuint buffer, std::uintptr_t offset) {
        gl().BindBuffer(c, GL_ARRAY_BUFFER, buffer);
        gl().VertexPointer(c, 3, GL_FLOAT, 24, reinterpret_cast<const void*>(offset));
        gl().EnableClientState(c, GL_VERTEX_ARRAY);
    }
    VertexInput* input(bool indexed = false) { return c.inputs->current(c.state, *c.buffers, *share, indexed); }
    GLuint names[2] = {};
};

TEST_F(VertexInputsTest, ArraysThatAreSetBackHaveTheirNameAgain) {
    positions_at(names[0], 0);
    VertexInput* const first = input();
    ASSERT_TRUE(first);
    EXPECT_EQ(input(), first);
    positions_at(names[1], 0);
    VertexInput* const second = input();
    ASSERT_TRUE(second);
    EXPECT_NE(second->id, first->id);
    positions_at(names[0], 0);
    EXPECT_EQ(input(), first);
    positions_at(names[0], 12);
    EXPECT_NE(input(), first);
}

TEST_F(VertexInputsTest, SaysWhereTheArraysLie) {
    positions_at(names[0], 48);
    gl().NormalPointer(c, GL_BYTE, 24, reinterpret_cast<const void*>(12));
    gl().EnableClientState(c, GL_NORMAL_ARRAY);
    gl().BindBuffer(c, GL_ELEMENT_ARRAY_BUFFER, names[1]);
    VertexInput* const found = input(true);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->definition().arrays.size(), 2u);
    EXPECT_EQ(found->positions()->offset, 48u);
    EXPECT_EQ(found->positions()->stride, 24);
    EXPECT_EQ(found->indices()->name, names[1]);
    EXPECT_EQ(found->elements(), (1200u - 48 - 12) / 24 + 1) << "of the array that ends first";
    EXPECT_NE(input(false), found) << "without indices it is another";
}

TEST_F(VertexInputsTest, NothingInTheProgramsMemoryHasOne) {
    ASSERT_TRUE(input()) << "no array is enabled";
    EXPECT_TRUE(input()->definition().arrays.empty());
    const GLfloat colors[4] = {};
    positions_at(names[0], 0);
    gl().BindBuffer(c, GL_ARRAY_BUFFER, 0);
    gl().ColorPointer(c, 4, GL_FLOAT, 0, colors);
    EXPECT_NE(input(), nullptr) << "it is not enabled";
    gl().EnableClientState(c, GL_COLOR_ARRAY);
    EXPECT_EQ(input(), nullptr);
}

TEST_F(VertexInputsTest, ADeletedBufferTakesItsInputsAlong) {
    positions_at(names[0], 0);
    const ClientName id = input()->id;
    EXPECT_TRUE(share->by_id.contains(id));
    gl().DeleteBuffers(c, 1, &names[0]);
    EXPECT_FALSE(share->by_id.contains(id));
    EXPECT_EQ(input(), nullptr) << "its array is enabled still";
}

TEST_F(VertexInputsTest, TheLeastUsedOnesGoWhenThereAreTooMany) {
    positions_at(names[0], 0);
    const ClientName first = input()->id;
    for (std::uintptr_t i = 1; i <= VertexInputs::kMost; ++i) {
        positions_at(names[1], i);
        ASSERT_TRUE(input());
        forget_inputs(c, c.inputs->take_unused());
        if (i != VertexInputs::kMost - 10) continue;
        positions_at(names[0], 0);
        EXPECT_EQ(input()->id, first) << "used again";
    }
    EXPECT_TRUE(share->by_id.contains(first));
    EXPECT_LT(share->by_id.size(), VertexInputs::kMost * 3 / 4);
    positions_at(names[0], 0);
    EXPECT_EQ(input()->id, first);
}

}  // namespace
}  // namespace wall::client
