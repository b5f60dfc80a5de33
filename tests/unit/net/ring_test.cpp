// SPDX-License-Identifier: MIT
#include "common/wire/ring.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <array>
#include <cstring>
#include <random>
#include <thread>
#include <vector>

namespace wall::wire {
namespace {

constexpr std::size_t kSize = RingMemory::kSmallest;

std::vector<std::byte> numbers(std::size_t count, unsigned first = 0) {
    std::vector<std::byte> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<std::byte>((first + i * 7) & 255);
    return out;
}

class ARing : public ::testing::Test {
protected:
    UniqueFd same_memory() const { return UniqueFd(::dup(writer_.descriptor())); }
    std::vector<std::byte> read(std::size_t most) {
        std::vector<std::byte> out(most);
        const auto bytes = reader_.read(out);
        EXPECT_TRUE(bytes);
        out.resize(bytes.value_or(0));
        return out;
    }

    RingWriter writer_ = std::move(*RingWriter::create(kSize));
    RingReader reader_ = std::move(*RingReader::open(same_memory()));
};

TEST_F(ARing, GivesWhatWasWritten) {
    EXPECT_TRUE(read(10).empty());
    const auto some = numbers(1000);
    EXPECT_EQ(writer_.write(some), some.size());
    EXPECT_EQ(read(300), std::vector(some.begin(), some.begin() + 300));
    EXPECT_EQ(read(5000), std::vector(some.begin() + 300, some.end()));
    EXPECT_TRUE(read(10).empty());
}

TEST_F(ARing, TakesAsMuchAsThereIsRoomFor) {
    const auto much = numbers(kSize + 100);
    EXPECT_EQ(writer_.write(much), kSize);
    EXPECT_EQ(writer_.write(much), 0u);
    EXPECT_EQ(read(50).size(), 50u);
    EXPECT_EQ(writer_.write(std::span(much).subspan(kSize)), 50u) << "over its end, at its beginning";
    const auto rest = read(2 * kSize);
    EXPECT_EQ(rest, std::vector(much.begin() + 50, much.begin() + kSize + 50));
}

TEST_F(ARing, SaysWhoWaitsOnce) {
    EXPECT_FALSE(writer_.reader_waits());
    EXPECT_TRUE(reader_.wait_for_more());
    writer_.write(numbers(1));
    EXPECT_TRUE(writer_.reader_waits());
    EXPECT_FALSE(writer_.reader_waits());
    EXPECT_FALSE(reader_.wait_for_more()) << "there is something";
    EXPECT_FALSE(writer_.wait_for_room()) << "there is room";

    writer_.write(numbers(kSize));
    EXPECT_TRUE(writer_.wait_for_room());
    read(kSize / 4);
    EXPECT_FALSE(reader_.writer_waits()) << "not worth a word yet";
    read(kSize / 4);
    EXPECT_TRUE(reader_.writer_waits());
    EXPECT_FALSE(reader_.writer_waits());
}

TEST_F(ARing, BringsAllThroughWhileBothSidesWait) {
    constexpr std::size_t kAll = 64 << 20;
    const auto some = numbers(100'000);
    std::thread writing([&] {
        std::minstd_rand chance(1);
        for (std::size_t sent = 0; sent < kAll;) {
            const std::size_t at = sent % some.size();
            const std::size_t n = std::min({some.size() - at, kAll - sent, std::size_t{1} + chance() % 90'000});
            sent += writer_.write(std::span(some).subspan(at, n));
            if (writer_.wait_for_room()) std::this_thread::yield();
            (void)writer_.reader_waits();
        }
    });
    std::vector<std::byte> room(50'000);
    std::size_t came = 0, wrong = 0;
    while (came < kAll) {
        const auto bytes = reader_.read(room);
        ASSERT_TRUE(bytes);
        for (std::size_t done = 0; done < *bytes;) {
            const std::size_t at = (came + done) % some.size(), n = std::min(*bytes - done, some.size() - at);
            wrong += std::memcmp(room.data() + done, some.data() + at, n) != 0;
            done += n;
        }
        came += *bytes;
        (void)reader_.writer_waits();
        if (reader_.wait_for_more()) std::this_thread::yield();
    }
    writing.join();
    EXPECT_EQ(came, kAll);
    EXPECT_EQ(wrong, 0u);
}

TEST_F(ARing, BelievesNoCounterThatCannotBe) {
    auto memory = std::move(*RingMemory::map(writer_.descriptor(), kSize));
    std::array<std::byte, 16> room;
    memory.counters().written = kSize + 1;
    EXPECT_FALSE(reader_.read(room));
    memory.counters().written = ~std::uint64_t{0};
    EXPECT_FALSE(reader_.read(room));
    memory.counters().read = 1;
    EXPECT_EQ(writer_.write(numbers(1)), 0u);
    EXPECT_TRUE(writer_.broken());
    EXPECT_FALSE(writer_.wait_for_room()) << "nobody waits for it";
}

TEST(RingMemoryOfOthers, IsRefusedUnlessItIsSealedAndOfAnExpectedSize) {
    const auto memory_of = [](std::size_t bytes, int seals) {
        UniqueFd fd(::memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING));
        EXPECT_EQ(::ftruncate(fd.get(), static_cast<off_t>(bytes)), 0);
        EXPECT_EQ(::fcntl(fd.get(), F_ADD_SEALS, seals), 0);
        return fd;
    };
    constexpr std::size_t kWhole = RingMemory::kPage + kSize;
    constexpr int kBoth = F_SEAL_SHRINK | F_SEAL_GROW;
    EXPECT_TRUE(RingReader::open(memory_of(kWhole, kBoth)));
    EXPECT_FALSE(RingReader::open(memory_of(kWhole, F_SEAL_GROW))) << "it could be taken away";
    EXPECT_FALSE(RingReader::open(memory_of(kWhole - 1, kBoth)));
    EXPECT_FALSE(RingReader::open(memory_of(kWhole + RingMemory::kPage, kBoth)));
    EXPECT_FALSE(RingReader::open(memory_of(RingMemory::kPage, kBoth)));
    EXPECT_FALSE(RingReader::open(memory_of(0, kBoth)));
    EXPECT_FALSE(RingReader::open(memory_of(RingMemory::kPage + 2 * RingMemory::kLargest, kBoth)));
    EXPECT_FALSE(RingReader::open(UniqueFd(::open("/dev/null", O_RDONLY | O_CLOEXEC))));
    EXPECT_FALSE(RingReader::open(UniqueFd()));
    EXPECT_FALSE(RingWriter::create(kSize + 1));
}

}  // namespace
}  // namespace wall::wire
