// SPDX-License-Identifier: MIT
#include "tileserver/compile/compile_trials.h"

#include <chrono>
#include <utility>

#include "common/log/log.h"
#include "tileserver/compile/compiler_messages.h"

namespace wall::tileserver {
namespace {

using Outcome = CompileTrial::Outcome;

/// After so long without work a compiler ends, and its memory is free.
constexpr std::chrono::seconds kIdle{30};

}  // namespace

CompileTrials::CompileTrials(const CompilerHost& host, std::function<void()> answered)
    : host_(host), answered_(std::move(answered)) {}

CompileTrials::~CompileTrials() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        for (const int socket : open_) ::shutdown(socket, SHUT_RDWR);
    }
    wanted_.notify_all();
    for (std::thread& worker : workers_) worker.join();
}

std::shared_ptr<const CompileTrial> CompileTrials::shader(GLenum type, std::span<const std::byte> source) {
    glapi::ContentHash hash;
    hash.ShaderCompile(type, source);
    return ask(hash.finish(), type, source);
}

std::shared_ptr<const CompileTrial> CompileTrials::program(std::span<const std::byte> definition) {
    glapi::ContentHash hash;
    hash.ProgramLink(definition);
    return ask(hash.finish(), 0, definition);
}

std::string CompileTrials::limits() const {
    const CompilerLimits& limits = host_.limits();
    std::string text = std::to_string(limits.processor_time.count()) + " s of processor time";
    if (limits.memory != 0) text += " or " + std::to_string(limits.memory >> 20) + " MiB of memory";
    return text;
}

std::shared_ptr<const CompileTrial> CompileTrials::ask(const glapi::ContentKey& key, GLenum shader_type,
                                                       std::span<const std::byte> bytes) {
    const std::lock_guard lock(mutex_);
    if (const auto known = known_.find(key); known != known_.end()) {
        ages_.splice(ages_.end(), ages_, known->second.age);
        return known->second.trial;
    }
    const auto trial = std::make_shared<CompileTrial>();
    trial->shader_type_ = shader_type;
    trial->bytes_.assign(bytes.begin(), bytes.end());
    if (unavailable_) {
        settle(*trial, Outcome::unavailable);
        return trial;
    }
    known_[key] = {trial, ages_.insert(ages_.end(), key)};
    if (known_.size() > kMostKnown) forget_oldest();
    waiting_.push_back(trial);
    if (waiting_.size() > idle_ && workers_.size() < kMostCompilers) workers_.emplace_back([this] { work(); });
    wanted_.notify_one();
    return trial;
}

void CompileTrials::forget_oldest() {
    known_.erase(ages_.front());
    ages_.pop_front();
}

void CompileTrials::work() {
    UniqueFd compiler;
    std::unique_lock lock(mutex_);
    while (!stop_) {
        if (waiting_.empty()) {
            ++idle_;
            const bool idle = wanted_.wait_for(lock, kIdle) == std::cv_status::timeout;
            --idle_;
            if (idle && waiting_.empty() && compiler) close(compiler);
            continue;
        }
        const auto trial = std::move(waiting_.front());
        waiting_.pop_front();
        lock.unlock();
        try_out(*trial, compiler);
        answered_();
        lock.lock();
    }
    if (compiler) close(compiler);
}

void CompileTrials::settle(CompileTrial& trial, Outcome outcome, std::vector<std::byte> answer) {
    trial.answer_ = std::move(answer);
    trial.bytes_ = {};
    trial.outcome_.store(outcome, std::memory_order_release);
}

bool CompileTrials::start(UniqueFd& compiler) {
    auto opened = host_.open();
    if (opened) {
        compiler = std::move(*opened);
        const std::lock_guard lock(mutex_);
        open_.insert(compiler.get());
        if (stop_) ::shutdown(compiler.get(), SHUT_RDWR);
    }
    if (opened && receive_message(compiler.get())) return true;
    if (opened) end(compiler);
    const std::lock_guard lock(mutex_);
    if (!stop_ && !std::exchange(unavailable_, true))
        log::warn("unlimited_compiler reason={}", log::quoted(opened ? "it cannot draw" : opened.error().message));
    return false;
}

void CompileTrials::try_out(CompileTrial& trial, UniqueFd& compiler) {
    if (!compiler && !start(compiler)) return settle(trial, Outcome::unavailable);
    if (send_message(compiler.get(), trial.shader_type_, trial.bytes_))
        if (auto answer = receive_message(compiler.get()))
            return settle(trial, Outcome::done, std::move(answer->bytes));
    end(compiler);
    settle(trial, Outcome::given_up);
}

void CompileTrials::end(UniqueFd& compiler) {
    const std::lock_guard lock(mutex_);
    close(compiler);
}

void CompileTrials::close(UniqueFd& compiler) {
    open_.erase(compiler.get());
    compiler.reset();
}

}  // namespace wall::tileserver
