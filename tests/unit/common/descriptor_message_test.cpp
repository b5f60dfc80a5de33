// SPDX-License-Identifier: MIT
#include "common/base/descriptor_message.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace wall {
namespace {

class DescriptorMessage : public testing::Test {
protected:
    void SetUp() override {
        int ends[2];
        ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
        here_.reset(ends[0]);
        there_.reset(ends[1]);
        ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
        read_.reset(ends[0]);
        write_.reset(ends[1]);
    }
    static std::span<const std::byte> bytes(std::string_view text) { return std::as_bytes(std::span(text)); }

    UniqueFd here_, there_, read_, write_;
    std::array<std::byte, 16> room_{};
};

TEST_F(DescriptorMessage, ArrivesWithItsBytesAndWorks) {
    ASSERT_EQ(send_with_descriptor(here_.get(), bytes("four"), write_.get()), 4);
    write_.reset();
    UniqueFd with;
    ASSERT_EQ(receive_with_descriptor(there_.get(), room_, with), 4);
    EXPECT_EQ(static_cast<char>(room_[0]), 'f');
    ASSERT_TRUE(with);
    EXPECT_EQ(::fcntl(with.get(), F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
    ASSERT_EQ(::write(with.get(), "x", 1), 1);
    char read = 0;
    EXPECT_EQ(::read(read_.get(), &read, 1), 1);
    EXPECT_EQ(read, 'x');
}

TEST_F(DescriptorMessage, OfBytesAloneLeavesWhatIsThere) {
    ASSERT_EQ(::send(here_.get(), "four", 4, 0), 4);
    UniqueFd with(::dup(read_.get()));
    const int before = with.get();
    EXPECT_EQ(receive_with_descriptor(there_.get(), room_, with), 4);
    EXPECT_EQ(with.get(), before);
}

TEST_F(DescriptorMessage, SaysThatThereIsNothingOrThatTheOtherEndIsGone) {
    UniqueFd with;
    EXPECT_EQ(receive_with_descriptor(there_.get(), room_, with, MSG_DONTWAIT), -1);
    EXPECT_EQ(errno, EAGAIN);
    here_.reset();
    EXPECT_EQ(receive_with_descriptor(there_.get(), room_, with), 0);
    EXPECT_EQ(send_with_descriptor(there_.get(), bytes("x"), read_.get()), -1) << "and no SIGPIPE";
    EXPECT_FALSE(with);
}

TEST_F(DescriptorMessage, TakesNoMoreThanOne) {
    int two[2] = {read_.get(), write_.get()};
    char byte = 'x';
    iovec piece{&byte, 1};
    alignas(cmsghdr) char control[CMSG_SPACE(sizeof two)] = {};
    msghdr message{};
    message.msg_iov = &piece;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* const about = CMSG_FIRSTHDR(&message);
    about->cmsg_level = SOL_SOCKET;
    about->cmsg_type = SCM_RIGHTS;
    about->cmsg_len = CMSG_LEN(sizeof two);
    std::memcpy(CMSG_DATA(about), two, sizeof two);
    ASSERT_EQ(::sendmsg(here_.get(), &message, 0), 1);
    const int lowest_free = UniqueFd(::dup(0)).get();
    {
        UniqueFd with;
        EXPECT_EQ(receive_with_descriptor(there_.get(), room_, with), 1);
    }
    EXPECT_EQ(UniqueFd(::dup(0)).get(), lowest_free) << "none stays open that nobody knows";
}

}  // namespace
}  // namespace wall
