// SPDX-License-Identifier: MIT
// What shaders write on a node: images, blocks of storage, atomic counters, compute shaders; and what a stream may say
// about them that no client does. What is bound is the session's own, or nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/glapi/program_format.h"
#include "tests/unit/tileserver/test_node.h"
#include "tileserver/objects/storage_access.h"

namespace wall::tileserver {
namespace {

using test::Batch;
using test::TestNode;
using test::TestSession;
namespace el = glstate::el;
namespace pack = glapi::pack;

constexpr ClientName kProgram(1), kBuffer(2), kTexture(3), kOther(4);

glapi::ProgramDefinition compute(std::string source) {
    return {{{GL_COMPUTE_SHADER, true, std::move(source)}}, {}, {}};
}

const glapi::ProgramDefinition kCounts = compute(
    "#version 430\nlayout(local_size_x = 4, local_size_y = 2) in;\n"
    "layout(std430, binding = 6) buffer Sums { uint sum[4]; };\n"
    "layout(binding = 1, offset = 4) uniform atomic_uint hits[2];\n"
    "layout(r32ui, binding = 2) uniform uimage2D cells;\n"
    "void main() { atomicAdd(sum[1], 1u); atomicCounterIncrement(hits[1]);\n"
    "  imageAtomicAdd(cells, ivec2(gl_LocalInvocationID.xy), 1u); }");

class ShaderMemoryTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL";
        node_.node->tiles = {{0, {0, 0, 8, 8}}};
        open(first_, 1);
        open(second_, 2);
    }
    void open(std::optional<TestSession>& session, std::uint32_t id) {
        session.emplace(*node_.node, SessionId(id));
        session->open_surface(8, 8, {0, 0, 8, 8});
        Batch batch;
        pack::ProgramLink(batch.buffer(), RequestId(5), kProgram, encode(kCounts));
        pack::BufferData(batch.buffer(), kBuffer, 64, GL_DYNAMIC_DRAW);
        pack::TexImage(batch.buffer(), kTexture, GL_TEXTURE_2D, 0, GL_R32UI, 8, 8, 1, 0, GL_RED_INTEGER,
                       GL_UNSIGNED_INT, {});
        session->expect_run(batch);
    }
    static Batch& bind(Batch& batch) {
        return batch.set<el::current_program>(kProgram.value)
            .set<el::storage_buffer>({kBuffer.value, 0, 16}, 6)
            .set<el::counter_buffer>({kBuffer.value, 32, 0}, 1)
            .set<el::image_unit>({kTexture.value, 0, 0, 0, GL_READ_WRITE, GL_R32UI}, 2);
    }
    static void dispatch(Batch& batch, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        batch.block(1, [&](auto& b) { pack::Dispatch(b, x, y, z); });
    }
    static std::vector<std::uint32_t> words(TestSession& session, ClientName buffer = kBuffer) {
        Batch batch;
        pack::BufferRead(batch.buffer(), RequestId(7), buffer, 0, 64);
        session.expect_run(batch);
        const auto& bytes = session.replies[RequestId(7)];
        std::vector<std::uint32_t> out(bytes.size() / 4);
        std::memcpy(out.data(), bytes.data(), out.size() * 4);
        return out;
    }
    glapi::ProgramReflection reflection() {
        return glapi::decode_reflection(first_->replies[RequestId(5)]).value_or(glapi::ProgramReflection());
    }

    TestNode node_;
    std::optional<TestSession> first_, second_;
};

TEST_F(ShaderMemoryTest, LinkingTellsWhatThereIs) {
    const auto told = reflection();
    ASSERT_TRUE(told.linked) << told.log;
    EXPECT_EQ(told.group_size, (std::array<std::uint32_t, 3>{4, 2, 1}));
    ASSERT_EQ(told.storage_blocks.size(), 1u);
    EXPECT_EQ(told.storage_blocks[0].name, "Sums");
    EXPECT_EQ(told.storage_blocks[0].binding, 6u);
    EXPECT_EQ(told.storage_blocks[0].bytes, 16u);
    EXPECT_TRUE(told.storage_blocks[0].written);
    // Which stages refer to a block, Mesa 22.3 does not tell.
    ASSERT_EQ(told.counter_buffers.size(), 1u);
    EXPECT_EQ(told.counter_buffers[0].stages, 1u << 5);
    EXPECT_EQ(told.counter_buffers[0].binding, 1u);
    const auto hits = std::ranges::find(told.uniforms, "hits", &glapi::ActiveUniform::name);
    ASSERT_NE(hits, told.uniforms.end());
    EXPECT_EQ(hits->counter_buffer, 0);
    EXPECT_EQ(hits->place.offset, 4);
    EXPECT_FALSE(hits->has_location());
    const auto cells = std::ranges::find(told.uniforms, "cells", &glapi::ActiveUniform::name);
    ASSERT_NE(cells, told.uniforms.end());
    EXPECT_EQ(cells->initial, std::vector<std::uint32_t>{2});
}

TEST_F(ShaderMemoryTest, ADispatchWritesWhatIsBound) {
    Batch batch;
    dispatch(bind(batch), 3, 1, 2);
    first_->expect_run(batch);
    const auto now = words(*first_);
    EXPECT_EQ(now[1], 48u) << "invocations";
    EXPECT_EQ(now[8 + 2], 48u) << "the second counter";
    EXPECT_EQ(words(*second_), std::vector<std::uint32_t>(16)) << "another session's";
}

TEST_F(ShaderMemoryTest, NothingOfAnotherSessionStaysBound) {
    Batch one, two;
    dispatch(bind(one), 1, 1, 1);
    first_->expect_run(one);
    dispatch(two.set<el::current_program>(kProgram.value), 1, 1, 1);
    second_->expect_run(two);
    EXPECT_EQ(words(*first_)[1], 8u);
    EXPECT_EQ(words(*second_), std::vector<std::uint32_t>(16));
}

TEST_F(ShaderMemoryTest, WhatIsNotThereIsNothing) {
    for (const glstate::ImageUnit& image : {glstate::ImageUnit{kTexture.value, -1, 0, 0, GL_READ_WRITE, GL_R32UI},
                                            glstate::ImageUnit{kTexture.value, 99, 0, 0, GL_READ_WRITE, GL_R32UI},
                                            glstate::ImageUnit{kTexture.value, 0, 7, -5, GL_READ_WRITE, GL_R32UI},
                                            glstate::ImageUnit{kTexture.value, 0, 0, 0, GL_FLOAT, GL_R32UI},
                                            glstate::ImageUnit{kTexture.value, 0, 0, 0, GL_READ_WRITE, GL_RGB},
                                            glstate::ImageUnit{kBuffer.value, 0, 0, 0, GL_READ_WRITE, GL_R32UI}}) {
        Batch batch;
        bind(batch).set<el::image_unit>(image, 2).set<el::storage_buffer>({kOther.value, 0, 0}, 6);
        batch.set<el::counter_buffer>({kBuffer.value, 1u << 30, 4}, 1);
        dispatch(batch, 1, 1, 1);
        first_->expect_run(batch);
        EXPECT_EQ(words(*first_), std::vector<std::uint32_t>(16));
    }
}

TEST_F(ShaderMemoryTest, DispatchesOfNoSizeAreRefusedOrNothing) {
    Batch nothing;
    dispatch(bind(nothing), 0, 5, 1);
    first_->expect_run(nothing);
    Batch no_program;
    dispatch(no_program.set<el::current_program>(0), 1, 1, 1);
    first_->expect_run(no_program);
    EXPECT_EQ(words(*first_), std::vector<std::uint32_t>(16));
    Batch large;
    constexpr auto kMost = std::numeric_limits<std::uint32_t>::max();
    dispatch(bind(large), kMost, kMost, kMost);
    EXPECT_FALSE(first_->run(large));
    Batch outside;
    pack::Dispatch(outside.buffer(), 1, 1, 1);
    EXPECT_FALSE(second_->run(outside));
}

TEST_F(ShaderMemoryTest, BlocksOfStorageAreBoundByTheClientsIndices) {
    Batch batch;
    auto definition = kCounts;
    definition.storage_blocks = {"Gone", "Sums"};
    pack::ProgramLink(batch.buffer(), RequestId(0), kProgram, encode(definition));
    pack::StorageBlock(batch.buffer(), kProgram, 0, 3);
    pack::StorageBlock(batch.buffer(), kProgram, 1, 3);
    bind(batch).set<el::storage_buffer>({}, 6).set<el::storage_buffer>({kBuffer.value, 0, 0}, 3);
    dispatch(batch, 1, 1, 1);
    first_->expect_run(batch);
    EXPECT_EQ(words(*first_)[1], 8u);
    for (const auto& [block, place] : {std::pair{2u, 0u}, std::pair{1u, unsigned{el::storage_buffer::count}}}) {
        TestSession third(*node_.node, SessionId(3));
        Batch bad;
        pack::ProgramLink(bad.buffer(), RequestId(0), kProgram, encode(definition));
        pack::StorageBlock(bad.buffer(), kProgram, block, place);
        EXPECT_FALSE(third.run(bad));
    }
}

TEST(StorageAccess, OnlyWhatSaysSoOfItselfIsOnlyRead) {
    const auto only_read = [](std::string source, std::string_view name = "B") {
        return is_only_read({{{GL_VERTEX_SHADER, true, std::move(source)}}, {}, {}}, name);
    };
    EXPECT_TRUE(only_read("layout(std430) readonly buffer B { int x; };"));
    EXPECT_TRUE(only_read("readonly /* } */ restrict layout(binding = 1) buffer B { int x; } b[2];", "B[1]"));
    EXPECT_TRUE(only_read("buffer readonly B { int x; };"));
    EXPECT_FALSE(only_read("buffer B { readonly int x; };"));
    EXPECT_FALSE(only_read("readonly buffer A { int y; }; buffer B { int x; };"));
    EXPECT_FALSE(only_read("// readonly\nbuffer B { int x; };"));
    EXPECT_FALSE(only_read("#define BLOCK readonly buffer\nBLOCK B { int x; };"));
    EXPECT_FALSE(only_read("readonly buffer C { int x; };"));
}

}  // namespace
}  // namespace wall::tileserver
