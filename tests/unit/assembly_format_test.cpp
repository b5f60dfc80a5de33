// SPDX-License-Identifier: MIT
// What travels of assembly programs: what was encoded comes back, and nothing else is taken.
#include "common/glapi/assembly_format.h"

#include <gtest/gtest.h>

#include <iterator>
#include <numeric>

namespace wall::glapi {
namespace {

template <class Decode>
void refuses_prefixes(const std::vector<std::byte>& bytes, Decode&& decode) {
    for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(decode(std::span(bytes).first(n))) << n;
    auto longer = bytes;
    longer.resize(bytes.size() + 4);
    EXPECT_FALSE(decode(longer));
}

/// local[2] + env[3] * vertex
const PositionProgram kPosition{{{"local", 2}, {"env", 3}},
                                "gl_Vertex",
                                true,
                                {{PositionOp::uniform, 1, 4, {0}},
                                 {PositionOp::uniform, 1, 4, {1}},
                                 {PositionOp::attribute, 1, 4, {}},
                                 {PositionOp::multiply, 1, 4, {1, 2}},
                                 {PositionOp::add, 1, 4, {0, 3}}}};

TEST(AssemblyFormat, Reflection) {
    AssemblyReflection in{true, -1, "fine", {}, true, {{3, TextureTarget::t2d}, {0, TextureTarget::cube_map}}};
    in.counts.resize(std::size(kAssemblyWords));
    std::iota(in.counts.begin(), in.counts.end(), 5u);
    in.invariant = true;
    in.position = kPosition;
    const auto bytes = encode(in);
    const auto out = decode_assembly_reflection(bytes);
    ASSERT_TRUE(out);
    EXPECT_TRUE(out->compiled && out->native && out->invariant);
    EXPECT_EQ(out->error_position, -1);
    EXPECT_EQ(out->message, "fine");
    EXPECT_EQ(out->counts, in.counts);
    EXPECT_EQ(out->textures, in.textures);
    EXPECT_EQ(out->position, kPosition);
    refuses_prefixes(bytes, decode_assembly_reflection);
    in.counts.pop_back();
    EXPECT_FALSE(decode_assembly_reflection(encode(in))) << "a word is not counted";
    in.counts.clear();
    in.compiled = false;
    EXPECT_TRUE(decode_assembly_reflection(encode(in)));
    in.textures[0].target = static_cast<TextureTarget>(kTextureTargets);
    EXPECT_FALSE(decode_assembly_reflection(encode(in))) << "no such target";
}

TEST(AssemblyFormat, Definition) {
    const AssemblyDefinition in{"!!ARBvp1.0 END", false, kPosition};
    const auto bytes = encode(in);
    const auto out = decode_assembly_definition(bytes);
    ASSERT_TRUE(out);
    EXPECT_EQ(out->source, in.source);
    EXPECT_FALSE(out->invariant);
    EXPECT_EQ(out->position, kPosition);
    refuses_prefixes(bytes, decode_assembly_definition);
}

TEST(AssemblyFormat, APositionIsLinkedToParametersOfBothKinds) {
    LinkedPosition position = link_position(kPosition);
    EXPECT_EQ(position.locations(), (std::vector<std::uint32_t>{2, kEnvLocations + 3}));
    constexpr std::array<float, 16> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    ASSERT_TRUE(position.transform(kIdentity, kIdentity)) << "parameters begin as 0";
    EXPECT_EQ(position.transform(kIdentity, kIdentity)->linear[0], 0);
    constexpr std::array<std::uint32_t, 4> kTwos{0x40000000, 0x40000000, 0x40000000, 0x40000000};
    position.set(kEnvLocations + 3, 4, kTwos);
    position.set(2, 4, kTwos);
    EXPECT_EQ(position.transform(kIdentity, kIdentity)->linear[0], 2);
    EXPECT_EQ(position.transform(kIdentity, kIdentity)->constant[3], 2);
    auto other = kPosition;
    other.uniforms[0].name = "mvp";
    EXPECT_FALSE(link_position(other).program().known());
    other = kPosition;
    other.uniforms[1].element = kMostLocalParameters;
    EXPECT_FALSE(link_position(other).program().known());
}

TEST(AssemblyFormat, ThePositionsAttribute) {
    auto position = kPosition;
    EXPECT_EQ(position_attribute(position), 0);
    position.attribute = "7";
    EXPECT_EQ(position_attribute(position), 7);
    for (const char* other : {"", "7x", "place"}) {
        position.attribute = other;
        EXPECT_EQ(position_attribute(position), -1) << other;
    }
    EXPECT_EQ(position_attribute({}), -1);
}

}  // namespace
}  // namespace wall::glapi
