// SPDX-License-Identifier: MIT
// Which name a context's arrays have among the nodes.
#include "client_lib/context/vertex_inputs.h"

#include <map>

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
    EXPECT_EQ(found->facts().elements, (1200u - 48 - 12) / 24 + 1) << "of the array that ends first";
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

TEST_F(VertexInputsTest, AreFoundInAnyOrder) {
    const std::uintptr_t offsets[] = {0, 24, 48, 72};
    std::map<std::uintptr_t, VertexInput*> found;
    for (const std::uintptr_t offset : offsets) {
        positions_at(names[0], offset);
        found[offset] = input();
    }
    for (const std::size_t i : {0, 1, 2, 3, 0, 1, 2, 3, 3, 0, 2, 1, 0, 3, 1, 2}) {
        positions_at(names[0], offsets[i]);
        EXPECT_EQ(input(), found[offsets[i]]) << i;
    }
    positions_at(names[1], 0);
    VertexInput* const of_other = input();
    gl().DeleteBuffers(c, 1, &names[0]);  // those before and after it are gone
    positions_at(names[1], 24);
    EXPECT_NE(input(), of_other);
    positions_at(names[1], 0);
    EXPECT_EQ(input(), of_other);
}

TEST_F(VertexInputsTest, FactsAreThoseOfTheBuffersAsTheyAre) {
    positions_at(names[0], 0);
    VertexInput* const found = input();
    const InputFacts before = found->facts();
    EXPECT_TRUE(found->settled());
    EXPECT_TRUE(before.plain());
    EXPECT_EQ(before.elements, 50u);
    gl().BufferSubData(c, GL_ARRAY_BUFFER, 0, 4, "abc");
    EXPECT_FALSE(found->settled());
    EXPECT_GT(found->facts().latest, before.latest);
    gl().BufferData(c, GL_ARRAY_BUFFER, 240, nullptr, GL_STATIC_DRAW);
    EXPECT_EQ(found->facts().elements, 10u);
    ASSERT_TRUE(gl().MapBuffer(c, GL_ARRAY_BUFFER, GL_WRITE_ONLY));
    EXPECT_TRUE(found->facts().blocked);
    EXPECT_FALSE(found->facts().plain());
    gl().UnmapBuffer(c, GL_ARRAY_BUFFER);
    EXPECT_TRUE(found->facts().plain());
    const std::size_t bytes = 240;
    gl().BufferStorage(c, GL_ARRAY_BUFFER, bytes, nullptr, GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT);
    ASSERT_TRUE(gl().MapBufferRange(c, GL_ARRAY_BUFFER, 0, bytes, GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT));
    EXPECT_TRUE(found->facts().written_unseen);
}

TEST_F(VertexInputsTest, DrawsThatAreCountedLaterAreCounted) {
    positions_at(names[0], 0);
    VertexInput* const found = input();
    ASSERT_TRUE(found->facts().kept);
    Churn& churn = c.buffers->by_id.at(ClientName(c.state.local.array_buffer))->churn;
    churn.changed(1000);
    found->count_drawn_later(10, 1, 1);  // 13 bytes an element: far less than what was written
    gl().BufferSubData(c, GL_ARRAY_BUFFER, 0, 4, "abc");
    EXPECT_TRUE(found->facts().kept) << "counted here, judged by the next change";
    gl().BufferSubData(c, GL_ARRAY_BUFFER, 0, 4, "xyz");
    EXPECT_FALSE(found->facts().kept);
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
