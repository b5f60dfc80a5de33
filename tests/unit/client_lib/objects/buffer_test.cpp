// SPDX-License-Identifier: MIT
// What a node is told of a buffer: all of it once, then what changed, and nothing that was never written.
#include "client_lib/objects/buffer.h"

#include <gtest/gtest.h>

#include <cstring>

#include "common/glapi/decoder.h"
#include "gen/glapi/null_handler.gen.h"

namespace wall::client {
namespace {

using Bytes = std::vector<std::byte>;

/// A node's copy, by the commands that it gets.
struct Copy : glapi::NullHandler {
    Bytes content;
    std::size_t told = 0;  ///< bytes of content
    void BufferData(ClientName, std::uint32_t size, GLenum) { content.assign(size, std::byte{0}); }
    void BufferSubData(ClientName, std::uint32_t offset, std::span<const std::byte> bytes) {
        ASSERT_LE(offset + bytes.size(), content.size());
        std::memcpy(content.data() + offset, bytes.data(), bytes.size());
        told += bytes.size();
    }
};

class BufferContentTest : public ::testing::Test {
protected:
    /// Brings the copy up to date; the bytes of content that it took.
    std::size_t follow(Copy& node, std::uint64_t& has) {
        node.told = 0;
        wire::PackBuffer batch;
        buffer.pack_changes(has, batch, no_limit);
        has = buffer.latest();
        EXPECT_TRUE(glapi::decode(batch.opcodes(), batch.operands(), node));
        return node.told;
    }
    void expect_same(const Copy& node) {
        ASSERT_EQ(node.content.size(), buffer.size());
        EXPECT_EQ(std::memcmp(node.content.data(), buffer.data(), buffer.size()), 0);
    }
    Buffer buffer{ClientName(1), 1};
    Copy copy;
    std::uint64_t known = 0;
};

TEST_F(BufferContentTest, IsSentOnceAndThenWhatChanges) {
    const Bytes content(10000, std::byte{7}), part(100, std::byte{9});
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    EXPECT_EQ(follow(copy, known), 10000u);
    expect_same(copy);
    EXPECT_EQ(follow(copy, known), 0u);
    buffer.write({5000, 5100}, part.data());
    EXPECT_EQ(follow(copy, known), 100u);
    expect_same(copy);
    Copy late;
    std::uint64_t nothing = 0;
    EXPECT_EQ(follow(late, nothing), 10000u);
    expect_same(late);
}

TEST_F(BufferContentTest, OfOneThatIsDefinedWithoutContentOnlyWhatIsWrittenIsSent) {
    const Bytes part(100, std::byte{9});
    buffer.define(nullptr, 1 << 20, GL_STREAM_DRAW);
    buffer.write({500, 600}, part.data());
    EXPECT_EQ(follow(copy, known), 100u);
    EXPECT_EQ(copy.content.size(), std::size_t{1} << 20);
    EXPECT_EQ(copy.content[550], std::byte{9});
    buffer.define(nullptr, 1 << 20, GL_STREAM_DRAW);
    buffer.write({700, 800}, part.data());
    EXPECT_EQ(follow(copy, known), 100u);
    EXPECT_EQ(copy.content[550], std::byte{0}) << "it is another";
}

TEST_F(BufferContentTest, AMappingCountsWhenItEnds) {
    buffer.define(nullptr, 1000, GL_STATIC_DRAW);
    std::memset(buffer.begin_writing(), 5, 1000);
    buffer.wrote({0, 1000});
    EXPECT_EQ(follow(copy, known), 1000u);
    expect_same(copy);
}

TEST_F(BufferContentTest, WhatIsReadStaysWhileItChanges) {
    const Bytes content(100, std::byte{7}), part(100, std::byte{9});
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    const BufferReading reading = buffer.read();
    buffer.write({0, 100}, part.data());
    EXPECT_EQ(reading.bytes()[0], std::byte{7});
    EXPECT_EQ(buffer.data()[0], std::byte{9});
}

TEST_F(BufferContentTest, AnyLargeOneTravelsInSeveralCommands) {
    const Bytes content(3 * kLargestBufferCommand + 5, std::byte{3});
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    wire::PackBuffer batch;
    int commands = 0;
    buffer.pack_changes(0, batch, [&] { ++commands; });
    EXPECT_EQ(commands, 4);
}

}  // namespace
}  // namespace wall::client
