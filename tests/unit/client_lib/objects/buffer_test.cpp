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

TEST_F(BufferContentTest, OfOneThatIsDefinedAgainOnlyWhatDiffersIsSent) {
    Bytes content(50000, std::byte{7});
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    EXPECT_EQ(follow(copy, known), 50000u);
    const std::uint64_t latest = buffer.latest();
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    EXPECT_EQ(buffer.latest(), latest);
    for (const std::size_t place : {0u, 20000u, 49999u}) content[place] = std::byte{8};
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    EXPECT_LE(follow(copy, known), 3 * 64u);
    expect_same(copy);
    EXPECT_EQ(std::memcmp(buffer.data(), content.data(), content.size()), 0);
}

TEST_F(BufferContentTest, OfOneThatIsDefinedAgainAllIsSentWhereMostDiffersOrTheUsageDoes) {
    const Bytes content(10000, std::byte{7}), other(10000, std::byte{8});
    for (const auto& [bytes, usage] :
         {std::pair(&content, GL_STATIC_DRAW), std::pair(&other, GL_STATIC_DRAW), std::pair(&other, GL_DYNAMIC_DRAW)}) {
        buffer.define(bytes->data(), bytes->size(), static_cast<GLenum>(usage));
        EXPECT_EQ(follow(copy, known), 10000u);
        expect_same(copy);
    }
    buffer.define(other.data(), 5000, GL_DYNAMIC_DRAW);
    EXPECT_EQ(follow(copy, known), 5000u);
    expect_same(copy);
}

TEST_F(BufferContentTest, WhatIsWrittenAgainIsNotSent) {
    const Bytes content(10000, std::byte{7});
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    follow(copy, known);
    buffer.write({1000, 9000}, content.data());
    EXPECT_EQ(follow(copy, known), 0u);
    Bytes changed = content;
    changed[5000] = std::byte{9};
    buffer.write({1000, 9000}, changed.data() + 1000);
    EXPECT_LE(follow(copy, known), 64u);
    expect_same(copy);
    EXPECT_EQ(std::memcmp(buffer.data(), changed.data(), changed.size()), 0);
}

TEST_F(BufferContentTest, WhatANodeWroteOrAProgramMapsIsNotTakenForWhatIsThere) {
    const Bytes content(1000, std::byte{7});
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    follow(copy, known);
    buffer.note_drawn();
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    EXPECT_EQ(follow(copy, known), 1000u);
    // Written into a mapping, not told, and then given as content: the nodes do not have it.
    std::byte* const mapped =
        buffer.map({{0, 1000}, GL_MAP_WRITE_BIT | GL_MAP_FLUSH_EXPLICIT_BIT | GL_MAP_PERSISTENT_BIT});
    mapped[10] = std::byte{8};
    const Bytes now(mapped, mapped + 1000);
    buffer.write({0, 1000}, now.data());
    EXPECT_EQ(follow(copy, known), 1000u);
    mapped[20] = std::byte{9};
    const Bytes then(mapped, mapped + 1000);
    buffer.define(then.data(), then.size(), GL_STATIC_DRAW);
    EXPECT_EQ(follow(copy, known), 1000u);
    expect_same(copy);
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

TEST_F(BufferContentTest, OfAMappingTheChangedPagesAreSent) {
    const Bytes content(10 * ChangedPages::kPageBytes, std::byte{7});
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    follow(copy, known);
    std::byte* mapped = buffer.map({{0, content.size()}, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT});
    EXPECT_TRUE(buffer.blocked());
    mapped[5] = mapped[3 * ChangedPages::kPageBytes] = std::byte{8};
    buffer.unmap();
    EXPECT_FALSE(buffer.mapping());
    EXPECT_EQ(follow(copy, known), 2 * ChangedPages::kPageBytes);
    expect_same(copy);
    buffer.map({{100, 200}, GL_MAP_READ_BIT});
    buffer.unmap();
    EXPECT_EQ(buffer.latest(), known) << "was only read";
}

TEST_F(BufferContentTest, OfOneThatWasNeverWrittenEvenZerosAreThere) {
    buffer.define(nullptr, 3 * ChangedPages::kPageBytes, GL_STREAM_DRAW);
    std::byte* mapped = buffer.map({{ChangedPages::kPageBytes, 3 * ChangedPages::kPageBytes}, GL_MAP_WRITE_BIT});
    std::memset(mapped, 0, 100);
    mapped[ChangedPages::kPageBytes] = std::byte{1};
    buffer.unmap();
    EXPECT_EQ(follow(copy, known), ChangedPages::kPageBytes);
    expect_same(copy);
    buffer.define(nullptr, 3 * ChangedPages::kPageBytes, GL_STREAM_DRAW);
    follow(copy, known);
    expect_same(copy);
}

TEST_F(BufferContentTest, AProgramThatTellsWhatItWroteIsBelieved) {
    const Bytes content(100000, std::byte{7});
    buffer.define(content.data(), content.size(), GL_STATIC_DRAW);
    follow(copy, known);
    std::byte* mapped = buffer.map({{1000, 50000}, GL_MAP_WRITE_BIT | GL_MAP_FLUSH_EXPLICIT_BIT});
    std::memset(mapped, 8, 49000);
    buffer.flush({2000, 2010});
    buffer.unmap();
    EXPECT_EQ(follow(copy, known), 10u);
    EXPECT_EQ(copy.content[2005], std::byte{8});
    EXPECT_EQ(copy.content[2010], std::byte{7});
}

TEST_F(BufferContentTest, WhatChangedBesideARangeOnItsPageIsNotLost) {
    constexpr GLbitfield kFlags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT;
    buffer.define_storage(nullptr, 3 * ChangedPages::kPageBytes, kFlags);
    std::byte* const mapped = buffer.map({{0, 3 * ChangedPages::kPageBytes}, kFlags});
    mapped[100] = mapped[108] = mapped[4000] = std::byte{1};
    EXPECT_TRUE(buffer.find_written({108, 200}));
    EXPECT_FALSE(buffer.find_written({100, 200})) << "it is known with the other";
    follow(copy, known);
    expect_same(copy);
}

TEST_F(BufferContentTest, APersistentMappingIsLookedAtWhereItIsUsed) {
    constexpr std::size_t kPage = ChangedPages::kPageBytes;
    buffer.define_storage(nullptr, 100 * kPage, GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT);
    std::byte* const mapped =
        buffer.map({{0, 100 * kPage}, GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT});
    EXPECT_FALSE(buffer.blocked());
    EXPECT_TRUE(buffer.written_unseen());
    mapped[3 * kPage] = mapped[50 * kPage] = std::byte{1};
    EXPECT_TRUE(buffer.find_written({2 * kPage, 4 * kPage}));
    EXPECT_EQ(follow(copy, known), kPage);
    EXPECT_FALSE(buffer.find_written({2 * kPage, 4 * kPage}));
    EXPECT_EQ(follow(copy, known), 0u);
    const BufferReading reading = buffer.read();
    const Bytes part(10, std::byte{5});
    buffer.write({0, 10}, part.data());
    EXPECT_EQ(mapped[0], std::byte{5}) << "it stays where it is, whoever reads";
    buffer.unmap();
    EXPECT_FALSE(buffer.written_unseen());
    follow(copy, known);
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

TEST(Buffer, BeginsWhereMappingsMay) {
    MapAllocator<std::byte> allocator;
    std::byte* const memory = allocator.allocate(3);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % kMapAlignment, 0u);
    allocator.deallocate(memory, 3);
}

}  // namespace
}  // namespace wall::client
