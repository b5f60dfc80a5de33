// SPDX-License-Identifier: MIT
#include "walld/control/who_is_there.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <thread>

#include "common/base/unique_fd.h"

namespace wall::walld {
namespace {

using namespace std::chrono_literals;

/// A name service that answers as late as it is told to.
class ASlowNameService : public ::testing::Test {
protected:
    void ask(std::uint32_t user) {
        asio::co_spawn(
            io_,
            [this, user]() -> asio::awaitable<void> {
                const auto person = co_await who_.user(user);
                answers_.push_back(person.name);
            },
            asio::detached);
    }
    /// Runs until `done()`; how often there was time for something else.
    template <class Done>
    int ticks_until(Done done) {
        int ticks = 0;
        asio::co_spawn(
            io_,
            [&]() -> asio::awaitable<void> {
                asio::steady_timer timer(io_);
                while (!done()) {
                    ++ticks;
                    timer.expires_after(1ms);
                    co_await timer.async_wait(asio::use_awaitable);
                }
            },
            asio::detached);
        io_.run();
        return ticks;
    }
    std::atomic<int> asked_{0};
    std::chrono::milliseconds pause_{300};
    std::vector<std::string> answers_;
    asio::io_context io_{1};
    WhoIsThere who_{io_.get_executor(), [this](std::uint32_t user) {
                        ++asked_;
                        std::this_thread::sleep_for(pause_);
                        if (user == 13) throw std::runtime_error("no name service");
                        return Person{Person::Kind::unix_user, "user " + std::to_string(user), user, Role::user};
                    }};
};

TEST_F(ASlowNameService, DoesNotStopTheThreadThatWaitsForIt) {
    pause_ = 500ms;
    ask(1);
    EXPECT_GE(ticks_until([this] { return !answers_.empty(); }), 20) << "frames would have gone on";
    EXPECT_EQ(answers_, std::vector<std::string>{"user 1"});
}

TEST_F(ASlowNameService, IsAskedOnceForManyConnections) {
    for (int i = 0; i < 20; ++i) ask(2);
    io_.run();
    EXPECT_EQ(answers_, std::vector<std::string>(20, "user 2"));
    EXPECT_EQ(asked_, 1);
    io_.restart();
    ask(2);
    ask(3);
    io_.run();
    EXPECT_EQ(asked_, 2) << "what it has said is kept";
}

TEST_F(ASlowNameService, ThatFailsIsAskedAgain) {
    pause_ = 1ms;
    ask(13);
    io_.run();
    io_.restart();
    ask(13);
    io_.run();
    EXPECT_EQ(answers_, std::vector<std::string>(2, "uid 13")) << "who may nothing, as far as anybody knows";
    EXPECT_EQ(asked_, 2);
}

TEST_F(ASlowNameService, IsNotAskedWhoNobodyIs) {
    std::optional<Person> person;
    asio::co_spawn(
        io_, [&]() -> asio::awaitable<void> { person = co_await who_.at(std::nullopt); }, asio::detached);
    io_.run();
    ASSERT_TRUE(person);
    EXPECT_EQ(person->kind, Person::Kind::unknown);
    EXPECT_EQ(asked_, 0);
}

TEST_F(ASlowNameService, IsAskedForTheSocketsUser) {
    int pair[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, pair), 0);
    const UniqueFd one(pair[0]), other(pair[1]);
    std::optional<Person> person;
    asio::co_spawn(
        io_, [&]() -> asio::awaitable<void> { person = co_await who_.at(ends_of(one.get())); }, asio::detached);
    io_.run();
    ASSERT_TRUE(person);
    EXPECT_EQ(person->user, ::geteuid());
}

/// Where the kernel does not answer for one socket, /proc/net/tcp is read, with however many lines it has.
TEST_F(ASlowNameService, AndASlowTableOfSocketsStopsNobodyEither) {
    WhoIsThere who(
        io_.get_executor(),
        [](std::uint32_t user) {
            return Person{Person::Kind::unix_user, "somebody", user, {}};
        },
        [](const SocketEnds&) {
            std::this_thread::sleep_for(500ms);
            return std::optional(Peer{77, 0});
        });
    std::optional<Person> person;
    asio::co_spawn(
        io_, [&]() -> asio::awaitable<void> { person = co_await who.at(SocketEnds{}); }, asio::detached);
    EXPECT_GE(ticks_until([&] { return person.has_value(); }), 20) << "frames would have gone on";
    EXPECT_EQ(person->user, 77u);
}

}  // namespace
}  // namespace wall::walld
