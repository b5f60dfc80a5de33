// SPDX-License-Identifier: MIT
// What must not end does not: with work that fails, with a listener that breaks, without descriptors.
#include "common/daemon/keep_running.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "common/net/sockets.h"

namespace wall::net {
namespace {

using namespace std::chrono_literals;

TEST(KeepRunning, BeginsAgainAfterAnErrorAndAfterAnEnd) {
    asio::io_context io(1);
    int calls = 0;
    bool stopping = false;
    const auto work = [&]() -> asio::awaitable<void> {
        ++calls;
        if (calls == 1) throw std::runtime_error("out of luck");
        if (calls == 3) stopping = true;
        co_return;
    };
    keep_running(io.get_executor(), {"test", work, [&] { return stopping; }, 1ms});
    io.run();
    EXPECT_EQ(calls, 3);
}

TEST(KeepRunning, StopsWithoutAnotherCall) {
    asio::io_context io(1);
    int calls = 0;
    keep_running(io.get_executor(), {"test",
                                     [&]() -> asio::awaitable<void> {
                                         ++calls;
                                         co_return;
                                     },
                                     [] { return true; }, 1ms});
    io.run();
    EXPECT_EQ(calls, 0);
}

/// A listener on a thread of its own, and the connections that it has taken.
class KeepAccepting : public ::testing::Test {
protected:
    void listen(const Address& address) {
        listener_.emplace(std::move(*Listener::open(io_.get_executor(), address)));
        keep_accepting(
            io_.get_executor(), *listener_, [this](StreamSocket) { ++taken_; }, [this] { return stopping_.load(); });
        thread_ = std::thread([this] { io_.run(); });
    }
    void TearDown() override {
        stopping_ = true;
        asio::post(io_, [this] { listener_->close(); });
        thread_.join();
        std::filesystem::remove_all(folder_);
    }
    /// Breaks the listening socket under the acceptor, as nothing that we do could.
    void break_socket() {
        sockaddr_storage name{};
        for (int fd = 3; fd < 256; ++fd) {
            int listens = 0;
            socklen_t size = sizeof listens;
            if (::getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) != 0 || !listens) continue;
            size = sizeof name;
            ::getsockname(fd, reinterpret_cast<sockaddr*>(&name), &size);
            ::shutdown(fd, SHUT_RDWR);
            return;
        }
        FAIL() << "no listening socket";
    }
    bool connects() { return static_cast<bool>(connect_to(listener_->address(), 1s)); }
    void expect_taken(int count) {
        for (int tries = 0; tries < 1000 && taken_ < count; ++tries) std::this_thread::sleep_for(10ms);
        EXPECT_EQ(taken_, count);
    }
    static std::string make_folder() {
        std::string path = "/tmp/wallgl-keep-XXXXXX";
        return ::mkdtemp(path.data());
    }

    const std::string folder_ = make_folder();
    asio::io_context io_{1};
    std::optional<Listener> listener_;
    std::atomic<bool> stopping_{false};
    std::atomic<int> taken_{0};
    std::thread thread_;
};

TEST_F(KeepAccepting, AListenerThatBreaksIsOpenedAgainOnItsPort) {
    listen({.path = {}, .host = "127.0.0.1", .port = 0});
    ASSERT_TRUE(connects());
    expect_taken(1);
    break_socket();
    for (int tries = 0; tries < 500 && !connects(); ++tries) std::this_thread::sleep_for(10ms);
    expect_taken(2);
}

TEST_F(KeepAccepting, APortThatAnotherProcessTookIsWaitedFor) {
    listen({.path = {}, .host = "127.0.0.1", .port = 0});
    ASSERT_TRUE(connects());
    expect_taken(1);
    // The other one is faster than the listener's next attempt, because it keeps its thread from it.
    std::optional<UniqueFd> other;
    std::atomic<bool> done{false};
    asio::post(io_, [&] {
        break_socket();
        for (int tries = 0; tries < 100 && !other; ++tries) {
            if (auto fd = listen_on(listener_->address())) other.emplace(std::move(*fd));
        }
        done = true;
    });
    while (!done) std::this_thread::sleep_for(1ms);
    ASSERT_TRUE(other);
    std::this_thread::sleep_for(1500ms);
    EXPECT_EQ(taken_, 1);
    other.reset();
    for (int tries = 0; tries < 500 && !connects(); ++tries) std::this_thread::sleep_for(10ms);
    expect_taken(2);
}

TEST_F(KeepAccepting, WithoutDescriptorsItWaitsForThem) {
    listen({.path = folder_ + "/socket", .host = {}, .port = 0});
    ASSERT_TRUE(connects());
    expect_taken(1);
    std::vector<UniqueFd> all;
    rlimit before{};
    ::getrlimit(RLIMIT_NOFILE, &before);
    rlimit few = before;
    few.rlim_cur = 64;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
    // The listener is done with this one before there are none: else it could take the one that is given back below.
    auto mine = connect_to(listener_->address(), 1s);
    expect_taken(2);
    for (int again = 0; again < 2; ++again) {
        for (int fd = 0; (fd = ::dup(0)) >= 0;) all.emplace_back(fd);
        EXPECT_EQ(errno, EMFILE);
        std::this_thread::sleep_for(100ms);
    }
    all.pop_back();
    const auto waits = connect_to(listener_->address(), 1s);  // takes the last one: none is left to accept it with
    ASSERT_TRUE(waits) << waits.error().message;
    std::this_thread::sleep_for(500ms);
    const int meanwhile = taken_;
    EXPECT_LE(meanwhile, 2);
    all.clear();
    ::setrlimit(RLIMIT_NOFILE, &before);
    expect_taken(3);
}

TEST(ListenPatiently, WaitsForTheAddressAndForNothingElse) {
    const Address asked{.path = {}, .host = "127.0.0.1", .port = 0};
    auto first = listen_on(asked);
    const auto taken = bound_address(first->get(), asked);
    std::thread later([&] {
        std::this_thread::sleep_for(300ms);
        first->reset();
    });
    UniqueFd second;
    const auto listening = listen_patiently([&]() -> Result<void> {
        auto fd = listen_on(taken);
        if (!fd) return tl::unexpected(fd.error());
        second = std::move(*fd);
        return {};
    });
    later.join();
    EXPECT_TRUE(listening);
    EXPECT_TRUE(second);
    int calls = 0;
    EXPECT_FALSE(listen_patiently([&]() -> Result<void> {
        ++calls;
        return fail("no such folder");
    }));
    EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace wall::net
