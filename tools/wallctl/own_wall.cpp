// SPDX-License-Identifier: MIT
#include "tools/wallctl/own_wall.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>

namespace wall::wallctl {
namespace {

using request::failed;
using request::Outcome;

constexpr std::chrono::seconds kStartLimit{20}, kEndLimit{5}, kReplyLimit{5};
constexpr std::chrono::milliseconds kPause{20};
constexpr int kNotStarted = 127;         // as shells have it
constexpr std::size_t kLastLines = 600;  // bytes of a log that are told

std::string toml_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

/// What the child does between fork and exec. It is no part of the terminal's Ctrl-C.
[[noreturn]] void become(const std::vector<std::string>& command, int log, pid_t parent) {
    ::setsid();
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(kNotStarted);
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    std::vector<char*> arguments;
    for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(arguments.front(), arguments.data());
    ::_exit(kNotStarted);
}

}  // namespace

std::int64_t own_wall_left(const std::vector<Covered>& windows, std::size_t index) {
    std::int64_t left = 0;
    for (std::size_t i = 0; i < index; ++i) left += windows[i].width;
    return left;
}

std::string own_wall_toml(const std::filesystem::path& folder, const std::vector<Covered>& windows) {
    const auto in_folder = [&](const char* name) { return toml_text("unix:" + (folder / name).string()); };
    std::string out = fmt::format("[wall]\nname = \"window\"\nstate_directory = {}\n[control]\nlisten = [{}]\n",
                                  toml_text((folder / "state").string()), in_folder("walld"));
    out += fmt::format("[[node]]\nname = \"window\"\nlisten = {}\n", in_folder("node"));
    for (std::size_t i = 0; i < windows.size(); ++i) {
        const Covered& window = windows[i];
        out += fmt::format("[[node.tile]]\nname = \"window {}\"\nrect = [{}, 0, {}, {}]\noutput = \"window\"\n", i + 1,
                           own_wall_left(windows, i), window.width, window.height);
        if (!window.display.empty()) out += fmt::format("display = {}\n", toml_text(window.display));
        out += fmt::format("parent = {}\n", window.number);
    }
    return out;
}

OwnWall::OwnWall(std::filesystem::path folder) : folder_(std::move(folder)) {
    walld_.address = "unix:" + (folder_ / "walld").string();
}

OwnWall::OwnWall(OwnWall&& other) noexcept
    : folder_(std::exchange(other.folder_, {})),
      walld_(std::move(other.walld_)),
      daemons_(std::exchange(other.daemons_, {})) {}

OwnWall::~OwnWall() {
    if (folder_.empty()) return;
    std::ranges::reverse(daemons_);  // nodes before walld, which they would look for
    for (const Daemon& daemon : daemons_) ::kill(daemon.pid, SIGTERM);
    const auto until = std::chrono::steady_clock::now() + kEndLimit;
    for (const Daemon& daemon : daemons_) {
        while (::waitpid(daemon.pid, nullptr, WNOHANG) == 0 && std::chrono::steady_clock::now() < until)
            std::this_thread::sleep_for(kPause);
        if (::kill(daemon.pid, 0) != 0) continue;
        ::kill(daemon.pid, SIGKILL);
        ::waitpid(daemon.pid, nullptr, 0);
    }
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
}

Outcome<OwnWall> OwnWall::start(const std::vector<Covered>& windows) {
    std::string name = (std::filesystem::temp_directory_path() / "wallctl-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) return failed("cannot make a folder: " + std::string(std::strerror(errno)));
    OwnWall wall{name};
    if (auto written = wall.write(windows); !written) return failed(written.error().message);
    const std::string config = (wall.folder_ / "wall.toml").string();
    if (auto run = wall.run("walld", {"--config", config}); !run) return tl::unexpected(run.error());
    if (auto run = wall.run("tileserver", {"--config", config, "--node", "window"}); !run)
        return tl::unexpected(run.error());
    if (auto serves = wall.wait_until_it_serves(); !serves) return tl::unexpected(serves.error());
    return wall;
}

Result<void> OwnWall::write(const std::vector<Covered>& windows) const {
    const auto path = folder_ / "wall.toml";
    std::ofstream file(path);
    file << own_wall_toml(folder_, windows);
    if (!file.flush()) return fail(path.string() + ": cannot be written");
    return {};
}

/// A program that lies beside this one.
Outcome<void> OwnWall::run(const std::string& program, std::vector<std::string> arguments) {
    std::error_code error;
    const auto path = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / program;
    if (!std::filesystem::exists(path, error))
        return failed(path.string() + ": not there (it is in the package wallgl-" +
                      (program == "walld" ? "walld" : "tileserver") + ")");
    arguments.insert(arguments.begin(), path.string());
    const int log = ::open((folder_ / (program + ".log")).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    const pid_t parent = ::getpid(), pid = ::fork();
    if (pid == 0) become(arguments, log, parent);
    if (log >= 0) ::close(log);
    if (pid < 0) return failed(path.string() + ": " + std::strerror(errno));
    daemons_.push_back({program, pid});
    return {};
}

Outcome<void> OwnWall::wait_until_it_serves() {
    for (const auto until = std::chrono::steady_clock::now() + kStartLimit; std::chrono::steady_clock::now() < until;
         std::this_thread::sleep_for(kPause)) {
        if (auto alive = check(); !alive) return alive;
        const auto nodes = request::ask(walld_, "nodes", nlohmann::json::object(), kReplyLimit);
        if (nodes && !nodes->json.empty() && nodes->json.front().value("up", false)) return {};
    }
    return failed("the program's own window cannot be drawn in: " + last_words("tileserver"));
}

Outcome<void> OwnWall::check() {
    for (const Daemon& daemon : daemons_) {
        siginfo_t ended{};
        if (::waitid(P_PID, static_cast<id_t>(daemon.pid), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
            ended.si_pid != 0)
            return failed(daemon.name + " has ended: " + last_words(daemon.name));
    }
    return {};
}

std::string OwnWall::last_words(const std::string& daemon) const {
    std::ifstream file(folder_ / (daemon + ".log"));
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (text.size() > kLastLines) text.erase(0, text.size() - kLastLines);
    return text;
}

Outcome<void> OwnWall::resize(const std::vector<Covered>& windows) const {
    if (auto written = write(windows); !written) return failed(written.error().message);
    const auto answer = request::ask(walld_, "reload", nlohmann::json::object(), kReplyLimit);
    if (!answer) return tl::unexpected(answer.error());
    return {};
}

}  // namespace wall::wallctl
