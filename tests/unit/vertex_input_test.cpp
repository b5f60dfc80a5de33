// SPDX-License-Identifier: MIT
// Vertex inputs on the wire: what was encoded comes back, and what no OpenGL command can say is refused.
#include "common/glstate/vertex_input.h"

#include <gtest/gtest.h>

namespace wall::glstate {
namespace {

VertexInputDefinition some_input() {
    return {
        ClientName(9),
        {{.place = kPositionArray, .buffer = ClientName(7), .offset = 12, .stride = 24, .type = GL_FLOAT, .size = 3},
         {.place = static_cast<std::uint32_t>(Attribute::color),
          .buffer = ClientName(7),
          .type = GL_UNSIGNED_BYTE,
          .size = 4,
          .normalized = 1}}};
}

TEST(VertexInput, ComesBackAsItWas) {
    const auto bytes = encode(some_input());
    const auto out = decode_vertex_input(bytes);
    ASSERT_TRUE(out);
    EXPECT_EQ(*out, some_input());
    EXPECT_TRUE(decode_vertex_input(encode({})));
    for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(decode_vertex_input(std::span(bytes).first(n))) << n;
    auto longer = bytes;
    longer.resize(bytes.size() + sizeof(InputArray));
    EXPECT_FALSE(decode_vertex_input(longer));
}

TEST(VertexInput, RefusesWhatNoCommandCanSay) {
    const auto refused = [](auto&& change) {
        auto definition = some_input();
        change(definition.arrays[0]);
        return !decode_vertex_input(encode(definition));
    };
    EXPECT_TRUE(refused([](InputArray& a) { a.place = kInputPlaces; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.place = static_cast<std::uint32_t>(Attribute::color); })) << "twice";
    EXPECT_TRUE(refused([](InputArray& a) { a.buffer = {}; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.stride = -1; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.type = GL_RGBA; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.size = 5; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.size = GL_BGRA, a.type = GL_SHORT; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.normalized = 2; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.reaches_as = kAsIntegers, a.type = GL_FLOAT; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.reaches_as = kAsDoubles, a.type = GL_FLOAT; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.reaches_as = kAsDoubles, a.type = GL_DOUBLE; })) << "not a generic one";
    EXPECT_TRUE(refused([](InputArray& a) { a.reaches_as = kAsDoubles + 1; }));
    EXPECT_TRUE(refused([](InputArray& a) { a.type = GL_UNSIGNED_INT_10F_11F_11F_REV, a.size = 4; }));
    EXPECT_FALSE(refused([](InputArray&) {}));
}

TEST(VertexInput, CountsTheElementsOfABuffer) {
    const InputArray array{.buffer = ClientName(1), .offset = 4, .stride = 16, .type = GL_FLOAT, .size = 3};
    EXPECT_EQ(array.elements_in(15), 0u);
    EXPECT_EQ(array.elements_in(16), 1u);
    EXPECT_EQ(array.elements_in(31), 1u);
    EXPECT_EQ(array.elements_in(32), 2u) << "the last one needs no whole stride";
    const InputArray close{.buffer = ClientName(1), .type = GL_SHORT, .size = 2};
    EXPECT_EQ(close.step(), 4u);
    EXPECT_EQ(close.elements_in(9), 2u);
}

TEST(VertexInput, KnowsTheTypesOfIndices) {
    EXPECT_EQ(index_bytes(GL_UNSIGNED_BYTE), 1u);
    EXPECT_EQ(index_bytes(GL_UNSIGNED_SHORT), 2u);
    EXPECT_EQ(index_bytes(GL_UNSIGNED_INT), 4u);
    EXPECT_EQ(index_bytes(GL_FLOAT), 0u);
}

}  // namespace
}  // namespace wall::glstate
