// SPDX-License-Identifier: MIT
#include "tileserver/compile/compile_trials.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>

#include "common/glapi/program_format.h"
#include "tests/unit/tileserver/monstrous_shader.h"

namespace wall::tileserver::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Outcome = CompileTrial::Outcome;

// No limit of memory: the sanitizers take terabytes of addresses.
constexpr CompilerLimits kShort{.processor_time = 1s, .time = 60s, .memory = 0};

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

class CompileTrialsTest : public ::testing::Test {
protected:
    void start(const std::string& backend = "egl", const CompilerLimits& limits = kShort) {
        auto host = CompilerHost::start(backend, limits);
        ASSERT_TRUE(host) << host.error().message;
        host_ = std::move(*host);
        trials_.emplace(*host_, [this] {
            const std::lock_guard lock(mutex_);
            ++answered_;
            changed_.notify_all();
        });
    }
    Outcome wait(const std::shared_ptr<const CompileTrial>& trial) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, 60s, [&] { return trial->outcome() != Outcome::pending; });
        return trial->outcome();
    }
    Outcome outcome_of(const std::string& source) {
        return wait(trials_->shader(GL_FRAGMENT_SHADER, bytes_of(source)));
    }
    bool can_draw() { return outcome_of("void main() {}") != Outcome::unavailable; }

    std::mutex mutex_;
    std::condition_variable changed_;
    int answered_ = 0;
    std::unique_ptr<CompilerHost> host_;
    std::optional<CompileTrials> trials_;
};

TEST_F(CompileTrialsTest, SayWhatTheCompilerSays) {
    start();
    if (!can_draw()) GTEST_SKIP() << "no driver";
    const auto good = trials_->shader(GL_FRAGMENT_SHADER, bytes_of("void main() { gl_FragColor = vec4(1); }"));
    const auto bad = trials_->shader(GL_FRAGMENT_SHADER, bytes_of("void main() { gl_FragColor = nonsense; }"));
    ASSERT_EQ(wait(good), Outcome::done);
    ASSERT_EQ(wait(bad), Outcome::done);
    const auto said = glapi::decode_compile_result(good->answer()),
               of_bad = glapi::decode_compile_result(bad->answer());
    ASSERT_TRUE(said && of_bad);
    EXPECT_TRUE(said->compiled) << said->log;
    EXPECT_FALSE(of_bad->compiled);
    EXPECT_NE(of_bad->log.find("nonsense"), std::string::npos) << of_bad->log;
}

TEST_F(CompileTrialsTest, KnowWhatWasTriedBefore) {
    start();
    if (!can_draw()) GTEST_SKIP() << "no driver";
    const int answered = answered_;
    EXPECT_EQ(outcome_of("void main() {}"), Outcome::done);
    EXPECT_EQ(answered_, answered) << "nothing was tried again";
    EXPECT_EQ(wait(trials_->shader(GL_VERTEX_SHADER, bytes_of("void main() {}"))), Outcome::done);
    EXPECT_EQ(answered_, answered + 1) << "the same text of another kind is another shader";
}

TEST_F(CompileTrialsTest, GiveUpWhatTakesTooLong) {
    start();
    if (!can_draw()) GTEST_SKIP() << "no driver";
    const auto begin = Clock::now();
    const auto monster = trials_->shader(GL_FRAGMENT_SHADER, bytes_of(monstrous_macros()));
    EXPECT_EQ(outcome_of("void main() { gl_FragColor = vec4(0); }"), Outcome::done) << "another compiler has time";
    EXPECT_EQ(wait(monster), Outcome::given_up);
    EXPECT_LT(Clock::now() - begin, 30s);
    EXPECT_EQ(outcome_of("void main() { gl_FragColor = vec4(0.5); }"), Outcome::done) << "there is a new compiler";
    EXPECT_EQ(trials_->limits(), "1 s of processor time");
}

TEST_F(CompileTrialsTest, GiveUpProgramsToo) {
    start();
    if (!can_draw()) GTEST_SKIP() << "no driver";
    glapi::ProgramDefinition definition;
    definition.shaders.push_back({.type = GL_FRAGMENT_SHADER, .compiled = true, .source = monstrous_shader()});
    EXPECT_EQ(wait(trials_->program(encode(definition))), Outcome::given_up);
    EXPECT_EQ(wait(trials_->program(bytes_of("nonsense"))), Outcome::done)
        << "the node's own reader says what is wrong";
}

/// A parser of its own, of what strangers have written: not in the node's process either.
TEST_F(CompileTrialsTest, RecogniseAProgramsPosition) {
    start();
    if (!can_draw()) GTEST_SKIP() << "no driver";
    const auto trial_of = [&](const std::string& source) {
        glapi::ProgramDefinition definition;
        definition.shaders.push_back({.type = GL_VERTEX_SHADER, .compiled = true, .source = source});
        const auto trial = trials_->program(encode(definition));
        EXPECT_EQ(wait(trial), Outcome::done);
        return glapi::decode_reflection(trial->answer());
    };
    const auto found = trial_of("uniform mat4 m; void main() { gl_Position = m * gl_Vertex; }");
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->linked);
    ASSERT_TRUE(found->position.known());
    EXPECT_EQ(found->position.uniforms.at(0).name, "m");
    const auto none = trial_of("void main() { gl_Position = vec4(float(gl_VertexID)); }");
    EXPECT_TRUE(none && !none->position.known());
}

TEST_F(CompileTrialsTest, EndWhileOneIsRunning) {
    start("egl", {.processor_time = 100s, .time = 100s, .memory = 0});
    if (!can_draw()) GTEST_SKIP() << "no driver";
    for (unsigned i = 0; i < 5; ++i) trials_->shader(GL_FRAGMENT_SHADER, bytes_of(monstrous_macros(36 + i)));
    const auto begin = Clock::now();
    trials_.reset();
    host_.reset();
    EXPECT_LT(Clock::now() - begin, 10s);
}

TEST_F(CompileTrialsTest, WithoutADriverNothingIsTried) {
    start("none such");
    EXPECT_EQ(outcome_of("void main() {}"), Outcome::unavailable);
    EXPECT_EQ(outcome_of("void main() { gl_FragColor = vec4(1); }"), Outcome::unavailable);
}

}  // namespace
}  // namespace wall::tileserver::test
