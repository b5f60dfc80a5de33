// SPDX-License-Identifier: MIT
#include "tests/integration/control/walld_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "common/net/sockets.h"
#include "common/wire/limits.h"

extern char** environ;

namespace wall::test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPoll{10};

constexpr const char* kNodes = R"(
[[node]]
name = "left"
[[node.tile]]
name = "l"
rect = [0, 0, 64, 48]
[[node]]
name = "right"
[[node.tile]]
name = "r"
rect = [64, 0, 64, 48]
)";

std::string content(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream out;
    out << file.rdbuf();
    return out.str();
}

}  // namespace

Walld::Walld(const std::string& more) {
    const bool own_control = more.find("[control]") != std::string::npos;
    std::ofstream(folder_.file("wall.toml"))
        << (own_control ? "" : "[control]\nlisten = [\"unix:" + folder_.file("walld.sock") + "\"]\n")
        << "[http]\nlisten = \"127.0.0.1:0\"\n"
        << more << kNodes;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 2, folder_.file("log").c_str(), O_WRONLY | O_CREAT, 0600);
    std::string config = folder_.file("wall.toml"), ready_file = folder_.file("ready"), program = WALLD_PROGRAM;
    std::string options[] = {"--config", "--ready-file"};
    char* arguments[] = {program.data(),    options[0].data(), config.data(),
                         options[1].data(), ready_file.data(), nullptr};
    EXPECT_EQ(posix_spawn(&process_, WALLD_PROGRAM, &actions, nullptr, arguments, environ), 0);
    posix_spawn_file_actions_destroy(&actions);
}

Walld::~Walld() {
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
}

bool Walld::ready() {
    for (const auto until = Clock::now() + kSoon; Clock::now() < until; std::this_thread::sleep_for(kPoll)) {
        const auto text = content(folder_.file("ready"));
        const std::string key = "\"http\":\"http://";
        const auto at = text.find(key);
        if (at == std::string::npos) continue;
        http_ = text.substr(at + key.size(), text.find('/', at + key.size()) - at - key.size());
        return true;
    }
    return false;
}

net::ControlClient Walld::connect() {
    if (!ready()) throw std::runtime_error("walld does not get ready: " + content(folder_.file("log")));
    auto client = net::ControlClient::connect(address(), kSoon);
    if (!client) throw std::runtime_error(client.error().message);
    return *std::move(client);
}

std::string Walld::http_get(const std::string& path) const {
    const auto fd = net::connect_to(*net::Address::parse(http_), kSoon);
    const std::string request = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
    if (!fd || ::send(fd->get(), request.data(), request.size(), MSG_NOSIGNAL) < 0) return "";
    std::string answer;
    char bytes[4096];
    for (ssize_t n; (n = ::read(fd->get(), bytes, sizeof bytes)) > 0;)
        answer.append(bytes, static_cast<std::size_t>(n));
    return answer.starts_with("HTTP/1.1 200 ") ? answer.substr(answer.find("\r\n\r\n") + 4) : "";
}

void Walld::signal(int number) const { ::kill(process_, number); }

Ended Walld::wait(std::chrono::milliseconds limit) {
    for (const auto until = Clock::now() + limit; Clock::now() < until; std::this_thread::sleep_for(kPoll)) {
        int status = 0;
        if (::waitpid(process_, &status, WNOHANG) != process_) continue;
        process_ = -1;
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder_.file("log"))};
    }
    return {-1, content(folder_.file("log"))};
}

void Peer::say(const proto::Envelope& message) { EXPECT_TRUE(client_.send(message)); }

std::optional<proto::Envelope> Peer::hear(proto::Envelope::MessageCase kind, std::chrono::milliseconds limit) {
    for (;;) {
        auto message = client_.receive(limit);
        if (!message) return std::nullopt;
        if (message->message_case() == kind) return *message;
    }
}

bool Peer::closed(std::chrono::milliseconds limit) {
    for (;;) {
        const auto message = client_.receive(limit);
        if (!message) return message.error().message.find("no answer") == std::string::npos;
    }
}

proto::NodeWelcome Peer::join(const std::string& node, std::uint32_t pid, std::uint64_t started_us) {
    proto::Envelope message;
    auto& hello = *message.mutable_node_hello();
    hello.set_version(wire::kProtocolVersion);
    hello.set_name(node);
    hello.set_pid(pid);
    hello.set_started_us(started_us);
    hello.set_address("unix:/tmp/no-node-" + node);
    say(message);
    const auto answer = hear(proto::Envelope::kNodeWelcome);
    EXPECT_TRUE(answer);
    return answer ? answer->node_welcome() : proto::NodeWelcome();
}

proto::ClientWelcome Peer::open(const proto::ClientHello& hello) {
    proto::Envelope message;
    *message.mutable_client_hello() = hello;
    message.mutable_client_hello()->set_version(wire::kProtocolVersion);
    say(message);
    const auto answer = hear(proto::Envelope::kClientWelcome);
    EXPECT_TRUE(answer);
    return answer ? answer->client_welcome() : proto::ClientWelcome();
}

proto::Placement Peer::open_surface(SurfaceId surface, std::uint32_t width, std::uint32_t height) {
    proto::Envelope message;
    message.mutable_surface_open()->set_surface(surface.value);
    message.mutable_surface_open()->set_width(width);
    message.mutable_surface_open()->set_height(height);
    say(message);
    const auto answer = hear(proto::Envelope::kPlacement);
    EXPECT_TRUE(answer);
    return answer ? answer->placement() : proto::Placement();
}

void Peer::rendered(SessionId session, SurfaceId surface, std::uint32_t frame) {
    proto::Envelope message;
    message.mutable_rendered()->set_session(session.value);
    message.mutable_rendered()->set_surface(surface.value);
    message.mutable_rendered()->set_frame(frame);
    say(message);
}

Output run(const std::string& command) {
    Output out;
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    char bytes[4096];
    for (std::size_t n; (n = ::fread(bytes, 1, sizeof bytes, pipe)) > 0;) out.text.append(bytes, n);
    const int status = ::pclose(pipe);
    if (WIFEXITED(status)) out.exit_code = WEXITSTATUS(status);
    return out;
}

}  // namespace wall::test
