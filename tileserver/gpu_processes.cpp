// SPDX-License-Identifier: MIT
#include "tileserver/gpu_processes.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include "common/daemon/keep_running.h"
#include "common/log/log.h"
#include "common/net/as_tuple.h"

extern "C" {  // which glibc 2.36 forgets there
#include <sys/pidfd.h>
}

namespace wall::tileserver {
namespace {

constexpr int kExitNotStarted = 127;  // as shells have it; an upgrade may just replace the program

Error system_error(const char* what) { return {std::string(what) + ": " + std::strerror(errno)}; }

/// What the child does between fork and exec.
[[noreturn]] void become(const std::vector<std::string>& command, const std::string& notify, std::uint64_t sign_us,
                         pid_t parent) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(kExitNotStarted);  // it is gone already
    ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    ::setenv("NOTIFY_SOCKET", notify.c_str(), 1);
    ::setenv("WATCHDOG_USEC", std::to_string(sign_us).c_str(), 1);
    ::unsetenv("WATCHDOG_PID");
    std::vector<char*> arguments;
    for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(arguments.front(), arguments.data());
    ::_exit(kExitNotStarted);
}

/// A message that one of our own user has sent; nothing if it is of somebody else, or none.
std::string receive(int socket) {
    std::array<char, 256> text{};
    iovec part{text.data(), text.size()};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(ucred))> control{};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const auto bytes = ::recvmsg(socket, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
    const cmsghdr* header = bytes > 0 ? CMSG_FIRSTHDR(&message) : nullptr;
    if (header == nullptr || header->cmsg_level != SOL_SOCKET || header->cmsg_type != SCM_CREDENTIALS) return {};
    ucred sender{};
    std::memcpy(&sender, CMSG_DATA(header), sizeof sender);
    if (sender.uid != ::geteuid()) return {};
    return {text.data(), static_cast<std::size_t>(bytes)};
}

std::string how_it_ended(int status) {
    if (WIFSIGNALED(status)) return std::string("signal ") + std::to_string(WTERMSIG(status));
    return "exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

GpuProcesses::GpuProcesses(const std::vector<std::string>& gpus, Command command, std::function<void()> ready,
                           Limits limits)
    : command_(std::move(command)),
      ready_(std::move(ready)),
      limits_(limits),
      signals_(io_, SIGINT, SIGTERM),
      watch_timer_(io_),
      systemd_timer_(io_),
      stop_timer_(io_) {
    for (const auto& name : gpus) gpus_.emplace_back(io_, name);
}

GpuProcesses::~GpuProcesses() {
    for (const auto& gpu : gpus_)
        if (gpu.pid != 0) ::kill(gpu.pid, SIGKILL);
}

Result<GpuProcesses::Ended> GpuProcesses::run() {
    for (auto& gpu : gpus_)
        if (auto listening = listen(gpu); !listening) return tl::unexpected(listening.error());
    signals_.async_wait([this](const boost::system::error_code& error, int signal) {
        if (error) return;
        log::info("stopping signal={}", signal);
        stop(Ended::stopped);
    });
    const auto stopping = [this] { return ended_.has_value(); };
    const auto lasting = [&](const std::string& name, std::function<asio::awaitable<void>()> work) {
        net::keep_running(io_.get_executor(), {name, std::move(work), stopping});
    };
    for (auto& gpu : gpus_) {
        lasting("signs", [this, &gpu] { return hear(gpu); });
        lasting("process", [this, &gpu] { return keep(gpu); });
    }
    lasting("watch", [this] { return watch(); });
    lasting("systemd", [this] { return feed_systemd(); });
    while (!ended_ || any_runs()) io_.run_one();
    return *ended_;
}

bool GpuProcesses::any_runs() const {
    return std::ranges::any_of(gpus_, [](const Gpu& gpu) { return gpu.pid != 0; });
}

/// At an address that the kernel chooses, which no file stands for.
Result<void> GpuProcesses::listen(Gpu& gpu) {
    const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0) return tl::unexpected(system_error("socket"));
    gpu.signs.assign(asio::local::datagram_protocol(), socket);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    socklen_t size = sizeof(sa_family_t);
    const int on = 1;
    if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
        ::setsockopt(socket, SOL_SOCKET, SO_PASSCRED, &on, sizeof on) != 0)
        return tl::unexpected(system_error("bind"));
    size = sizeof address;
    if (::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        return tl::unexpected(system_error("getsockname"));
    gpu.signs_name = "@" + std::string(address.sun_path + 1, size - sizeof(sa_family_t) - 1);
    return {};
}

Result<void> GpuProcesses::start(Gpu& gpu) {
    const auto command = command_(gpu.name);
    const auto sign_us = static_cast<std::uint64_t>(std::chrono::microseconds(limits_.sign).count());
    const pid_t parent = ::getpid(), pid = ::fork();
    if (pid < 0) return tl::unexpected(system_error("fork"));
    if (pid == 0) become(command, gpu.signs_name, sign_us, parent);
    const int process = ::pidfd_open(pid, 0);
    if (process < 0) {
        const auto error = system_error("pidfd_open");
        ::kill(pid, SIGKILL);
        ::waitpid(pid, nullptr, 0);
        return tl::unexpected(error);
    }
    gpu.process.assign(process);
    gpu.pid = pid;
    gpu.ready = false;
    gpu.last_sign = Clock::now();
    return {};
}

asio::awaitable<void> GpuProcesses::keep(Gpu& gpu) {
    while (!ended_) {
        if (const auto started = start(gpu); started) {
            co_await gpu.process.async_wait(asio::posix::stream_descriptor::wait_read, net::kTuple);
            int status = 0;
            ::waitpid(gpu.pid, &status, 0);
            gpu.process.close();
            gpu.pid = 0;
            has_ended(gpu, status);
        } else {
            log::error("gpu_not_started gpu={} reason={}", log::quoted(gpu.name), log::quoted(started.error().message));
        }
        if (ended_) break;
        gpu.pause.expires_after(limits_.pause);
        co_await gpu.pause.async_wait(net::kTuple);
    }
}

void GpuProcesses::has_ended(Gpu& gpu, int status) {
    gpu.tried = true;
    if (ended_) return;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (code == kExitDescribed) return stop(Ended::starts_anew);
    log::error("gpu_ended gpu={} by={}", log::quoted(gpu.name), log::quoted(how_it_ended(status)));
    if (code == kExitMistake) return stop(Ended::mistaken);
    tell_ready();
}

asio::awaitable<void> GpuProcesses::hear(Gpu& gpu) {
    for (;;) {
        co_await gpu.signs.async_wait(asio::local::datagram_protocol::socket::wait_read, net::kTuple);
        if (ended_) co_return;
        const auto message = receive(gpu.signs.native_handle());
        if (message.empty()) continue;
        gpu.last_sign = Clock::now();
        if (gpu.ready || ("\n" + message).find("\nREADY=1") == std::string::npos) continue;
        gpu.ready = gpu.tried = true;
        tell_ready();
    }
}

void GpuProcesses::tell_ready() {
    if (ready_ && std::ranges::all_of(gpus_, &Gpu::tried)) std::exchange(ready_, nullptr)();
}

asio::awaitable<void> GpuProcesses::watch() {
    while (!ended_) {
        watch_timer_.expires_after(std::min(limits_.silence, limits_.start) / 4);
        co_await watch_timer_.async_wait(net::kTuple);
        for (auto& gpu : gpus_) {
            if (gpu.pid == 0 || Clock::now() - gpu.last_sign < (gpu.ready ? limits_.silence : limits_.start)) continue;
            log::error("gpu_silent gpu={} pid={}", log::quoted(gpu.name), gpu.pid);
            ::kill(gpu.pid, SIGKILL);
            gpu.last_sign = Clock::now();
        }
    }
}

/// That this process lives, as often as it wants to hear it.
asio::awaitable<void> GpuProcesses::feed_systemd() {
    std::uint64_t limit = 0;  // microseconds
    const bool wanted = sd_watchdog_enabled(0, &limit) > 0;
    while (!ended_) {
        if (wanted) sd_notify(0, "WATCHDOG=1");
        systemd_timer_.expires_after(wanted ? std::chrono::microseconds(limit / 2) : std::chrono::hours(1));
        co_await systemd_timer_.async_wait(net::kTuple);
    }
}

void GpuProcesses::stop(Ended how) {
    if (ended_) return;
    ended_ = how;
    // Not of one that starts anew: systemd would see to it that it ends.
    if (how != Ended::starts_anew) sd_notify(0, "STOPPING=1");
    const auto end = [this](int signal) {
        for (const auto& gpu : gpus_)
            if (gpu.pid != 0) ::kill(gpu.pid, signal);
    };
    end(SIGTERM);
    stop_timer_.expires_after(limits_.stop);
    stop_timer_.async_wait([end](const boost::system::error_code& error) {
        if (!error) end(SIGKILL);
    });
    for (auto& gpu : gpus_) {
        gpu.pause.cancel();
        gpu.signs.cancel();
    }
    watch_timer_.cancel();
    systemd_timer_.cancel();
    signals_.cancel();
}

}  // namespace wall::tileserver
