// SPDX-License-Identifier: MIT
// Shaders and programs on trial: whether a compiler in a process of its own (compiler_host.h) comes through with them.
// What has been tried once is known from then on, whoever sends it. A few compilers work side by side, so that one that
// is busy for its whole time keeps nobody else waiting. Any thread.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "common/glapi/content_hash.h"
#include "tileserver/compile/compiler_host.h"

namespace wall::tileserver {

class CompileTrial {
public:
    enum class Outcome : std::uint8_t {
        pending,
        done,
        given_up,     ///< the compiler took more than it may, or crashed
        unavailable,  ///< there are no compilers of their own here
    };
    Outcome outcome() const { return outcome_.load(std::memory_order_acquire); }
    /// Of a shader that is done: the encoded glapi::CompileResult. Of an assembly program: a glapi::AssemblyReflection.
    /// Of a program: a ProgramReflection, of which only
    /// `linked` and `position` are told. Empty: it was no shader, or no program.
    const std::vector<std::byte>& answer() const { return answer_; }

private:
    friend class CompileTrials;
    GLenum shader_type_ = 0;
    std::vector<std::byte> bytes_, answer_;
    std::atomic<Outcome> outcome_{Outcome::pending};
};

class CompileTrials {
public:
    static constexpr std::size_t kMostCompilers = 3;
    static constexpr std::size_t kMostKnown = 4096;

    /// `answered` is called in another thread whenever the outcome of a trial is known. `host` outlives it.
    CompileTrials(const CompilerHost& host, std::function<void()> answered);
    /// Waits for no trial.
    ~CompileTrials();
    CompileTrials(const CompileTrials&) = delete;

    /// `type`: also the target of an assembly program.
    std::shared_ptr<const CompileTrial> shader(GLenum type, std::span<const std::byte> source);
    std::shared_ptr<const CompileTrial> program(std::span<const std::byte> definition);
    /// "more than 10 s of processor time, ...": what a compiler may take.
    std::string limits() const;

private:
    struct Known {
        std::shared_ptr<CompileTrial> trial;
        std::list<glapi::ContentKey>::iterator age;
    };
    std::shared_ptr<const CompileTrial> ask(const glapi::ContentKey& key, GLenum shader_type,
                                            std::span<const std::byte> bytes);
    void forget_oldest();
    void work();
    void settle(CompileTrial& trial, CompileTrial::Outcome outcome, std::vector<std::byte> answer = {});
    /// Asks a compiler, which is started if there is none. Its socket may be shut down by the destructor meanwhile.
    void try_out(CompileTrial& trial, UniqueFd& compiler);
    /// True: a compiler is there and ready.
    bool start(UniqueFd& compiler);
    void end(UniqueFd& compiler);
    void close(UniqueFd& compiler);  // the mutex is held

    const CompilerHost& host_;
    const std::function<void()> answered_;

    std::mutex mutex_;  // guards what follows
    std::condition_variable wanted_;
    std::map<glapi::ContentKey, Known> known_;
    std::list<glapi::ContentKey> ages_;  // oldest first
    std::deque<std::shared_ptr<CompileTrial>> waiting_;
    std::set<int> open_;  // compilers' sockets
    std::vector<std::thread> workers_;
    std::size_t idle_ = 0;
    bool stop_ = false, unavailable_ = false;
};

}  // namespace wall::tileserver
