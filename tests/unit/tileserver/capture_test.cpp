// SPDX-License-Identifier: MIT
// Transform feedback on a node: values go to the session's buffers, behind each other, whatever others draw meanwhile.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "common/glapi/program_format.h"
#include "common/glstate/framebuffer.h"
#include "common/glstate/vertex_input.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver {
namespace {

using test::Batch;
using test::Pixels;
using test::TestNode;
using test::TestSession;
namespace el = glstate::el;
namespace pack = glapi::pack;

constexpr ClientName kProgram(1), kBuffer(2), kCapture(3), kImage(4), kTarget(5), kInput(6), kQuery(7);
constexpr std::uint32_t kBytes = 256;

class CaptureTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no EGL";
        node_.node->tiles = {{0, {0, 0, 8, 8}}};
        open(first_, 1);
        open(second_, 2);
    }
    void open(std::optional<TestSession>& session, std::uint32_t id) {
        glapi::ProgramDefinition program{
            {{GL_VERTEX_SHADER, true,
              "#version 130\nin vec4 place; out vec3 doubled; void main() { doubled = 2.0 * place.xyz; gl_Position = "
              "place; }"},
             {GL_FRAGMENT_SHADER, true,
              "#version 130\nout vec4 color; in vec3 doubled; void main() { color = vec4(1); }"}},
            {{0, "place"}},
            {}};
        program.feedback = {GL_INTERLEAVED_ATTRIBS, {"doubled"}};
        session.emplace(*node_.node, SessionId(id));
        session->open_surface(8, 8, {0, 0, 8, 8});
        Batch batch;
        wire::PackBuffer& b = batch.buffer();
        pack::ProgramLink(b, RequestId(0), kProgram, encode(program));
        pack::BufferData(b, kBuffer, kBytes, GL_DYNAMIC_COPY);
        pack::Renderbuffer(b, kImage, 0, GL_RGBA8, 1, 1);
        glstate::FramebufferDefinition target;
        target.attachments = {{GL_COLOR_ATTACHMENT0, kImage, GL_RENDERBUFFER, 0, 0}};
        pack::Framebuffer(b, kTarget, encode(target));
        define(b, {kBuffer.value, 0, 0});
        session->expect_run(batch);
    }
    static void define(wire::PackBuffer& b, const glstate::BufferRange& part, GLenum mode = GL_POINTS) {
        pack::Capture(b, kCapture, mode, std::as_bytes(std::span(&part, 1)));
    }
    /// Points of this x, or other primitives, captured.
    static Batch points(std::initializer_list<float> xs, GLenum mode = GL_POINTS) {
        Batch batch;
        pack::BindTargets(batch.buffer(), kTarget, {}, 1);
        batch.set<el::current_program>(kProgram.value).set<el::capture>(kCapture.value);
        batch.block(1, [&](auto& b) {
            pack::Begin(b, mode);
            for (const float x : xs) pack::Vertex2f(b, x, 0);
            pack::End(b);
        });
        pack::BindTargets(batch.buffer(), {}, {}, 1);
        batch.set<el::capture>(0).set<el::current_program>(0);
        return batch;
    }
    static std::vector<float> captured(TestSession& session, std::size_t count) {
        Batch batch;
        pack::BufferRead(batch.buffer(), RequestId(7), kBuffer, 0, kBytes);
        session.expect_run(batch);
        const auto& bytes = session.replies[RequestId(7)];
        EXPECT_EQ(bytes.size(), kBytes);
        std::vector<float> values(kBytes / sizeof(float));
        if (bytes.size() == kBytes) std::memcpy(values.data(), bytes.data(), kBytes);
        std::vector<float> xs;
        for (std::size_t i = 0; i < count; ++i) xs.push_back(values[3 * i]);
        return xs;
    }

    /// As the node answers; empty: it does not know.
    static std::vector<std::uint64_t> counts(TestSession& session, ClientName capture = kCapture) {
        Batch batch;
        pack::CaptureCounts(batch.buffer(), RequestId(8), capture);
        session.expect_run(batch);
        const auto& bytes = session.replies[RequestId(8)];
        std::vector<std::uint64_t> out(bytes.size() / sizeof(std::uint64_t));
        if (!bytes.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
        return out;
    }
    /// What was captured, as points of 8 pixels in the window.
    static Batch captured_points(ClientName capture, std::uint32_t stream = 0) {
        Batch batch;
        glstate::VertexInputDefinition input{
            {}, {{.place = glstate::kPositionArray, .buffer = kBuffer, .type = GL_FLOAT, .size = 3}}};
        pack::VertexInput(batch.buffer(), kInput, glstate::encode(input));
        batch.set<el::color>({0, 1, 0, 1}).set<el::point_size>(8);
        batch.block(1, [&](auto& b) {
            pack::Clear(b, GL_COLOR_BUFFER_BIT);
            pack::DrawCaptured(b, kInput, capture, GL_POINTS, stream, 1);
        });
        return batch;
    }

    TestNode node_;
    std::optional<TestSession> first_, second_;
};

TEST_F(CaptureTest, BehindItsEndItTellsHowManyThereWere) {
    first_->expect_run(points({1, 2}));
    EXPECT_TRUE(counts(*first_).empty()) << "it goes on";
    first_->expect_run(points({3}));
    Batch end;
    pack::CaptureEnd(end.buffer(), kCapture);
    first_->expect_run(end);
    EXPECT_EQ(counts(*first_), (std::vector<std::uint64_t>{3, 0, 0, 0}));
    first_->expect_run(points({4}));
    EXPECT_EQ(counts(*first_).at(0), 3u) << "it is over";
    EXPECT_EQ(captured(*first_, 4).back(), 0.f);
    EXPECT_TRUE(counts(*first_, ClientName(99)).empty());
}

TEST_F(CaptureTest, AQueryCountsTheSame) {
    Batch query;
    query.set<el::captured_query>(kQuery.value);
    first_->expect_run(query);
    first_->expect_run(points({1, 2, 3}));
    Batch ask;
    ask.set<el::captured_query>(0);
    pack::QueryResult(ask.buffer(), RequestId(9), kQuery);
    pack::CaptureEnd(ask.buffer(), kCapture);
    first_->expect_run(ask);
    std::uint64_t counted = 0;
    ASSERT_EQ(first_->replies[RequestId(9)].size(), sizeof counted);
    std::memcpy(&counted, first_->replies[RequestId(9)].data(), sizeof counted);
    EXPECT_EQ(counted, 3u);
    EXPECT_EQ(counts(*first_).at(0), 3u);
}

TEST_F(CaptureTest, AsManyAreDrawnAsWereCaptured) {
    first_->expect_run(points({0.01f, 0.02f}));
    Batch end;
    pack::CaptureEnd(end.buffer(), kCapture);
    first_->expect_run(end);
    first_->expect_run(captured_points(kCapture));
    EXPECT_EQ(first_->read(0, {3, 3, 1, 1}), (Pixels{0, 255, 0, 255}));
    EXPECT_EQ(first_->session.work.gl_errors, 0u);
    EXPECT_FALSE(first_->run(captured_points(kCapture, kVertexStreams))) << "no such stream";
}

TEST_F(CaptureTest, ANodeThatCameLateDrawsAsManyAsAnotherHasCounted) {
    const auto say = [](std::uint64_t count) {
        Batch batch;
        const std::array<std::uint64_t, kVertexStreams> all{count};
        pack::CaptureCounted(batch.buffer(), ClientName(20), std::as_bytes(std::span(all)));
        return batch;
    };
    first_->expect_run(say(1));
    EXPECT_EQ(counts(*first_, ClientName(20)).at(0), 1u);
    first_->expect_run(captured_points(ClientName(20)));
    EXPECT_EQ(first_->read(0, {3, 3, 1, 1}), (Pixels{0, 255, 0, 255}));
    EXPECT_FALSE(first_->run(say(2))) << "defined once";
    std::optional<TestSession> third;
    open(third, 3);
    third->expect_run(say(~std::uint64_t{0}));
    third->expect_run(captured_points(ClientName(20)));
    EXPECT_EQ(third->read(0, {3, 3, 1, 1}), (Pixels{0, 0, 0, 255})) << "more than there are in the buffer";
    EXPECT_FALSE(third->run(captured_points(kCapture))) << "one that goes on";
}

TEST_F(CaptureTest, ValuesGoToTheBuffer) {
    first_->expect_run(points({0.25f, -0.5f}));
    EXPECT_EQ(captured(*first_, 3), (std::vector{0.5f, -1.f, 0.f}));
}

TEST_F(CaptureTest, ItGoesOnBehindWhatOthersDraw) {
    first_->expect_run(points({1}));
    second_->expect_run(points({5, 6}));
    Batch seen;
    seen.block(1, [](auto& b) {
        pack::Clear(b, GL_COLOR_BUFFER_BIT);
        pack::Color3f(b, 0, 1, 0);
        pack::Begin(b, GL_QUADS);
        for (const auto& v :
             {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}})
            pack::Vertex2f(b, v[0], v[1]);
        pack::End(b);
    });
    second_->expect_run(seen);
    EXPECT_EQ(second_->read(0, {3, 3, 1, 1}), (Pixels{0, 255, 0, 255})) << "others' pixels are drawn";
    first_->expect_run(points({2, 3}));
    second_->expect_run(points({7}));
    EXPECT_EQ(captured(*first_, 4), (std::vector{2.f, 4.f, 6.f, 0.f}));
    EXPECT_EQ(captured(*second_, 4), (std::vector{10.f, 12.f, 14.f, 0.f}));
}

TEST_F(CaptureTest, ItGoesOnBehindOthersOfAnotherMode) {
    const auto begin_again = [](TestSession& session, GLenum mode) {
        Batch batch;
        pack::ObjectDelete(batch.buffer(), kCapture);
        define(batch.buffer(), {kBuffer.value, 0, 0}, mode);
        session.expect_run(batch);
    };
    begin_again(*first_, GL_LINES);
    begin_again(*second_, GL_TRIANGLES);
    first_->expect_run(points({1, 2}, GL_LINES));
    second_->expect_run(points({5, 6, 7}, GL_TRIANGLES));
    first_->expect_run(points({3, 4}, GL_LINES));
    second_->expect_run(points({8, 9, 10}, GL_TRIANGLES));
    EXPECT_EQ(captured(*first_, 5), (std::vector{2.f, 4.f, 6.f, 8.f, 0.f}));
    EXPECT_EQ(captured(*second_, 7), (std::vector{10.f, 12.f, 14.f, 16.f, 18.f, 20.f, 0.f}));
    EXPECT_EQ(first_->session.work.gl_errors + second_->session.work.gl_errors, 0u);
    std::optional<TestSession> third;  // nothing begins where there is no buffer
    open(third, 3);
    Batch nowhere;
    pack::ObjectDelete(nowhere.buffer(), kCapture);
    define(nowhere.buffer(), {99, 0, 0}, GL_LINES);
    third->expect_run(nowhere);
    third->expect_run(points({1, 2}, GL_LINES));
    first_->expect_run(points({11, 12}, GL_LINES));
    EXPECT_EQ(captured(*first_, 7), (std::vector{2.f, 4.f, 6.f, 8.f, 22.f, 24.f, 0.f}));
}

TEST_F(CaptureTest, AnEndedOneIsOver) {
    first_->expect_run(points({1}));
    Batch again;
    pack::ObjectDelete(again.buffer(), kCapture);
    define(again.buffer(), {kBuffer.value, 24, 24});
    first_->expect_run(again);
    first_->expect_run(points({4, 5, 6}));
    EXPECT_EQ(captured(*first_, 5), (std::vector{2.f, 0.f, 8.f, 10.f, 0.f})) << "no further than its part";
}

TEST_F(CaptureTest, WhatGoesMeanwhileDoesNoHarm) {
    first_->expect_run(points({1}));
    Batch gone;
    pack::ObjectDelete(gone.buffer(), kBuffer);
    pack::ObjectDelete(gone.buffer(), kProgram);
    first_->expect_run(gone);
    first_->expect_run(points({2}));
    Batch read;
    pack::BufferRead(read.buffer(), RequestId(7), kBuffer, 0, 4);
    first_->expect_run(read);
    EXPECT_TRUE(first_->replies[RequestId(7)].empty());
    first_.reset();
    second_->expect_run(points({3}));
    EXPECT_EQ(captured(*second_, 1), std::vector{6.f});
}

TEST_F(CaptureTest, PartsThatNoBufferHasAreNotWritten) {
    for (const glstate::BufferRange& part :
         {glstate::BufferRange{kBuffer.value, kBytes, 0}, glstate::BufferRange{kBuffer.value, 2, 0},
          glstate::BufferRange{99, 0, 0}, glstate::BufferRange{kBuffer.value, kBytes - 4, 0xffffffffu}}) {
        std::optional<TestSession> session;
        open(session, 3);
        Batch other;
        pack::ObjectDelete(other.buffer(), kCapture);
        define(other.buffer(), part);
        session->expect_run(other);
        session->expect_run(points({1, 2}));
        EXPECT_EQ(captured(*session, 2), (std::vector{0.f, 0.f})) << part.buffer << ' ' << part.offset;
    }
}

TEST_F(CaptureTest, WhatNoClientSendsIsRefused) {
    const auto refused = [this](auto&& say) {
        std::optional<TestSession> session;
        open(session, 3);
        Batch batch;
        say(batch.buffer());
        return !session->run(batch);
    };
    const std::array<glstate::BufferRange, 5> many{};
    EXPECT_TRUE(refused([](auto& b) { define(b, {kBuffer.value, 0, 0}); })) << "twice";
    EXPECT_TRUE(refused([&](auto& b) { pack::Capture(b, ClientName(9), GL_POINTS, std::as_bytes(std::span(many))); }));
    EXPECT_TRUE(
        refused([&](auto& b) { pack::Capture(b, ClientName(9), GL_QUADS, std::as_bytes(std::span(many).first(1))); }));
    EXPECT_TRUE(refused([](auto& b) { pack::BufferRead(b, RequestId(1), kBuffer, 0, 0xffffffffu); }));
}

}  // namespace
}  // namespace wall::tileserver
