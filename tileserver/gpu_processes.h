// SPDX-License-Identifier: MIT
// A node of several GPUs: a process for each, kept alive here. To its children it is what systemd is to a daemon: it
// hears when they are ready and that they live, starts again those that end, kills those that hang, and ends with them.
// One thread; uses no driver.
//
//     starting ──ready──► ready ──ends, or says nothing for too long──► waiting for its next start ──► starting
//     any of them ──by a mistake of its description──► all are stopped
//     any of them ──is described otherwise──► all are stopped, to be started anew
#pragma once

#include <sys/types.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/datagram_protocol.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace wall::tileserver {

namespace asio = boost::asio;

/// How a process of one GPU ends that is not asked to.
inline constexpr int kExitMistake = 2;      ///< there is no use in starting it again
inline constexpr int kExitDescribed = 100;  ///< its node is described otherwise now

class GpuProcesses {
public:
    using Clock = std::chrono::steady_clock;
    struct Limits {
        std::chrono::milliseconds pause{1000};                     ///< before one that has ended is started again
        std::chrono::milliseconds sign{10'000};                    ///< how often each says that it lives, at least
        std::chrono::milliseconds start{60'000}, silence{40'000};  ///< without a sign before the first one, and later
        std::chrono::milliseconds stop{4000};                      ///< from SIGTERM to SIGKILL
    };
    enum class Ended { stopped, starts_anew, mistaken };
    using Command = std::function<std::vector<std::string>(const std::string& gpu)>;

    /// `ready` is called once, when each GPU has been ready or has ended for the first time.
    GpuProcesses(const std::vector<std::string>& gpus, Command command, std::function<void()> ready, Limits limits);
    GpuProcesses(const std::vector<std::string>& gpus, Command command, std::function<void()> ready)
        : GpuProcesses(gpus, std::move(command), std::move(ready), Limits{}) {}
    ~GpuProcesses();

    /// Until SIGTERM or SIGINT, or until they cannot go on as they are. No process of a GPU is left then.
    Result<Ended> run();

private:
    struct Gpu {
        Gpu(asio::io_context& io, std::string name_of_gpu)
            : name(std::move(name_of_gpu)), signs(io), process(io), pause(io) {}
        std::string name;
        asio::local::datagram_protocol::socket signs;  // it sends there
        std::string signs_name;                        // as NOTIFY_SOCKET has it
        asio::posix::stream_descriptor process;        // a pidfd
        asio::steady_timer pause;
        pid_t pid = 0;  // 0: it does not run
        bool ready = false, tried = false;
        Clock::time_point last_sign;
    };

    Result<void> listen(Gpu& gpu);
    Result<void> start(Gpu& gpu);
    asio::awaitable<void> keep(Gpu& gpu);
    asio::awaitable<void> hear(Gpu& gpu);
    asio::awaitable<void> watch();
    asio::awaitable<void> feed_systemd();
    void has_ended(Gpu& gpu, int status);
    void tell_ready();
    void stop(Ended how);
    bool any_runs() const;

    asio::io_context io_{1};
    Command command_;
    std::function<void()> ready_;
    Limits limits_;
    std::list<Gpu> gpus_;
    asio::signal_set signals_;
    asio::steady_timer watch_timer_, systemd_timer_, stop_timer_;
    std::optional<Ended> ended_;  // none: they are to run
};

}  // namespace wall::tileserver
