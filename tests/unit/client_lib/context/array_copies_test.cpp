// SPDX-License-Identifier: MIT
// Copies of arrays in the program's memory: what of it counts as changed.
#include "client_lib/context/array_copies.h"

#include "client_lib/context/buffer_binding.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

constexpr std::size_t kBytes = 100000;

class ArrayCopiesTest : public ContextTest {
protected:
    ArrayBlock block() const { return {reinterpret_cast<std::uintptr_t>(memory.data()), 16, 12}; }
    /// Whether the copy was changed.
    bool refresh(ByteRange range) {
        ArrayCopy& copy = c.copies->copy_of(block());
        const std::uint64_t before = copy.buffer ? copy.buffer->latest() : 0;
        c.copies->refresh(holder, block(), copy, range);
        return copy.buffer->latest() != before;
    }
    std::byte copied(std::size_t at) { return c.copies->copy_of(block()).buffer->data()[at]; }

    const ArrayCopies::Holder holder{*share, *c.buffers, [](const Buffer&) {}};
    std::vector<std::byte> memory = std::vector<std::byte>(kBytes, std::byte{1});
};

TEST_F(ArrayCopiesTest, OnlyWhatIsTakenIsLookedAt) {
    EXPECT_TRUE(refresh({50000, 60000}));
    EXPECT_EQ(copied(55000), std::byte{1});
    EXPECT_EQ(copied(49999), std::byte{0});
    EXPECT_FALSE(refresh({50000, 60000}));
    memory[70000] = std::byte{2};
    EXPECT_FALSE(refresh({50000, 60000}));
    memory[55000] = std::byte{2};
    EXPECT_TRUE(refresh({50000, 60000}));
    EXPECT_EQ(copied(55000), std::byte{2});
    EXPECT_TRUE(refresh({0, kBytes}));
    EXPECT_EQ(std::memcmp(&c.copies->copy_of(block()).buffer->data()[0], memory.data(), kBytes), 0);
}

TEST_F(ArrayCopiesTest, WhatIsLockedIsLookedAtOnce) {
    gl().LockArraysEXT(c, 0, 1000);
    EXPECT_TRUE(refresh({0, 1000}));
    memory[5] = std::byte{2};
    EXPECT_FALSE(refresh({0, 1000})) << "the program has promised";
    EXPECT_TRUE(refresh({0, 2000})) << "not so much";
    gl().UnlockArraysEXT(c);
    memory[6] = std::byte{2};
    EXPECT_TRUE(refresh({0, 1000}));
    gl().LockArraysEXT(c, 0, 1000);
    memory[7] = std::byte{2};
    EXPECT_TRUE(refresh({0, 1000})) << "another lock";
}

TEST_F(ArrayCopiesTest, ErrorsOfLocks) {
    gl().UnlockArraysEXT(c);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().LockArraysEXT(c, -1, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().LockArraysEXT(c, 0, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().LockArraysEXT(c, 5, 7);
    gl().LockArraysEXT(c, 5, 7);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    GLint count = 0;
    gl().GetIntegerv(c, GL_ARRAY_ELEMENT_LOCK_COUNT_EXT, &count);
    EXPECT_EQ(count, 7);
}

TEST_F(ArrayCopiesTest, TheLeastUsedGoWhenThereAreTooMany) {
    for (std::size_t i = 0; i <= ArrayCopies::kMost; ++i) {
        ArrayCopy& copy = c.copies->copy_of({reinterpret_cast<std::uintptr_t>(memory.data()) + i, 16, 12});
        copy.last_use = c.copies->next_use();
        c.copies->refresh(holder, {reinterpret_cast<std::uintptr_t>(memory.data()) + i, 16, 12}, copy, {0, 100});
    }
    auto taken = c.copies->take_unused();
    EXPECT_GT(taken.size(), ArrayCopies::kMost / 3);
    EXPECT_LT(taken.size(), ArrayCopies::kMost * 2 / 3);
    const std::size_t known = share->by_id.size();
    for (auto& buffer : taken) let_go_of_buffer(c, std::move(buffer));
    EXPECT_EQ(share->by_id.size(), known - taken.size());
    EXPECT_TRUE(c.copies->take_unused().empty());
}

}  // namespace
}  // namespace wall::client
