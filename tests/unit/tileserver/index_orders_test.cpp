// SPDX-License-Identifier: MIT
// Meshes that stay are drawn in another order, and look the same.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "common/glapi/program_format.h"
#include "common/glstate/pieces.h"
#include "common/glstate/vertex_input.h"
#include "tests/unit/tileserver/test_node.h"
#include "tileserver/objects/buffer.h"

namespace wall::tileserver::test {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr geom::Rect kWindow{0, 0, kWidth, kHeight};
constexpr ClientName kVertices(11), kIndices(12), kInput(13), kPieces(14), kProgram(15);
constexpr unsigned kWait = 2 * IndexOrders::kFirstWait;  // at most

struct Vertex {
    float x, y, z;
    std::uint8_t color[4];
};

/// Triangles of a wavy grid, in any order.
struct Mesh {
    static constexpr std::uint32_t kColumns = 40, kRows = 30;
    std::vector<Vertex> vertices;
    std::vector<std::uint16_t> indices;

    Mesh() {
        for (std::uint32_t row = 0; row <= kRows; ++row)
            for (std::uint32_t column = 0; column <= kColumns; ++column) {
                const float x = 1.8f * static_cast<float>(column) / kColumns - 0.9f,
                            y = 1.8f * static_cast<float>(row) / kRows - 0.9f;
                vertices.push_back(
                    {x,
                     y,
                     0.4f * std::sin(7 * x) * std::cos(4 * y),
                     {static_cast<std::uint8_t>(column * 37), static_cast<std::uint8_t>(row * 53), 90, 255}});
            }
        std::vector<std::array<std::uint32_t, 3>> triangles;
        const auto at = [](std::uint32_t column, std::uint32_t row) { return row * (kColumns + 1) + column; };
        for (std::uint32_t row = 0; row < kRows; ++row)
            for (std::uint32_t column = 0; column < kColumns; ++column) {
                triangles.push_back({at(column, row), at(column + 1, row), at(column, row + 1)});
                triangles.push_back({at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)});
            }
        std::ranges::shuffle(triangles, std::mt19937(1));
        for (const auto& each : triangles)
            for (const std::uint32_t index : each) indices.push_back(static_cast<std::uint16_t>(index));
    }
    std::int32_t count() const { return static_cast<std::int32_t>(indices.size()); }
};

class IndexOrdersTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, kWindow}};
        node_.node->orders_triangles = true;
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(kWidth, kHeight, kWindow);
        Batch batch;
        auto& b = batch.buffer();
        pack::BufferData(b, kVertices, static_cast<std::uint32_t>(mesh_.vertices.size() * sizeof(Vertex)),
                         GL_STATIC_DRAW);
        pack::BufferSubData(b, kVertices, 0, std::as_bytes(std::span(mesh_.vertices)));
        pack::BufferData(b, kIndices, static_cast<std::uint32_t>(mesh_.indices.size() * sizeof(std::uint16_t)),
                         GL_STATIC_DRAW);
        pack::BufferSubData(b, kIndices, 0, std::as_bytes(std::span(mesh_.indices)));
        const glstate::VertexInputDefinition input{kIndices,
                                                   {{.place = glstate::kPositionArray,
                                                     .buffer = kVertices,
                                                     .stride = sizeof(Vertex),
                                                     .type = GL_FLOAT,
                                                     .size = 3},
                                                    {.place = static_cast<std::uint32_t>(glstate::Attribute::color),
                                                     .buffer = kVertices,
                                                     .offset = offsetof(Vertex, color),
                                                     .stride = sizeof(Vertex),
                                                     .type = GL_UNSIGNED_BYTE,
                                                     .size = 4,
                                                     .normalized = 1}}};
        pack::VertexInput(b, kInput, glstate::encode(input));
        batch.set<el::depth_test>(true);
        session_->expect_run(batch);
        plain_ = memory();
    }
    std::uint64_t memory() const { return session_->session.objects.find<Buffer>(kIndices)->bytes(); }
    /// There is a copy of the indices in another order.
    bool ordered() const { return memory() > plain_; }
    template <class Change>
    void draw(unsigned times, Change&& change, ClientName pieces = {}) {
        for (unsigned i = 0; i < times; ++i) {
            Batch batch;
            change(batch);
            batch.block(1, [&](auto& b) {
                pack::Clear(b, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
                pack::DrawElements(b, kInput, pieces, GL_TRIANGLES, mesh_.count(), GL_UNSIGNED_SHORT, 0, 0);
            });
            session_->expect_run(batch);
        }
    }
    void draw(unsigned times, ClientName pieces = {}) {
        draw(
            times, [](Batch&) {}, pieces);
    }
    Pixels picture() { return session_->read(0, kWindow); }

    TestNode node_;
    std::optional<TestSession> session_;
    Mesh mesh_;
    std::uint64_t plain_ = 0;
};

TEST_F(IndexOrdersTest, AMeshThatStaysLooksTheSame) {
    draw(kWait / 2 - 1);
    EXPECT_FALSE(ordered());
    const Pixels before = picture();
    draw(kWait / 2 + 1);
    EXPECT_TRUE(ordered());
    EXPECT_EQ(count_different(before, picture()), 0u);
    draw(3);
    EXPECT_EQ(count_different(before, picture()), 0u);
    EXPECT_EQ(memory(), plain_ + mesh_.indices.size() * sizeof(std::uint16_t));
}

TEST_F(IndexOrdersTest, FlatColoursAreOfTheSameVertex) {
    const auto flat = [](Batch& batch) { batch.set<el::shade_model>(GL_FLAT); };
    draw(1, flat);
    const Pixels before = picture();
    draw(kWait, flat);
    EXPECT_TRUE(ordered());
    EXPECT_EQ(count_different(before, picture()), 0u);
}

TEST_F(IndexOrdersTest, PiecesStayPieces) {
    constexpr std::uint32_t kStep = 768;
    std::vector<glstate::PieceBox> boxes;
    for (std::size_t first = 0; first < mesh_.indices.size(); first += kStep) {
        geom::Box box;  // every second one is said to lie nowhere that the tile sees
        const float x = boxes.size() % 2 == 0 ? 0.0f : 9.0f;
        box.add(_mm_setr_ps(x - 0.5f, -1, -1, 1));
        box.add(_mm_setr_ps(x + 0.5f, 1, 1, 1));
        boxes.push_back(glstate::piece_box(box));
    }
    ASSERT_GT(boxes.size(), 5u);
    Batch batch;
    pack::DrawPieces(batch.buffer(), kPieces, kStep, 0, std::as_bytes(std::span(boxes)));
    session_->expect_run(batch);
    draw(1, kPieces);
    const Pixels before = picture();
    draw(kWait, kPieces);
    EXPECT_TRUE(ordered());
    EXPECT_EQ(count_different(before, picture()), 0u);
    draw(1);
    EXPECT_GT(count_different(before, picture()), 0u) << "half of it was left out";
}

TEST_F(IndexOrdersTest, WhatChangesIsForgottenAndLeftAloneForLonger) {
    draw(kWait);
    ASSERT_TRUE(ordered());
    std::ranges::rotate(mesh_.indices, mesh_.indices.begin() + 3);
    mesh_.indices.resize(900);  // the rest is drawn as it was
    Batch batch;
    pack::BufferSubData(batch.buffer(), kIndices, 0, std::as_bytes(std::span(mesh_.indices)));
    session_->expect_run(batch);
    EXPECT_FALSE(ordered());
    draw(kWait - 1);
    EXPECT_FALSE(ordered());
    const Pixels before = picture();
    draw(kWait + 1);
    EXPECT_TRUE(ordered());
    EXPECT_EQ(count_different(before, picture()), 0u);
}

TEST_F(IndexOrdersTest, WhereTheOrderIsSeenItStays) {
    draw(2 * kWait, [](Batch& batch) { batch.set<el::blend_enabled>(1); });
    EXPECT_FALSE(ordered());
    draw(2 * kWait, [](Batch& batch) { batch.set<el::blend_enabled>(0).set<el::depth_test>(false); });
    EXPECT_FALSE(ordered());
    draw(kWait, [](Batch& batch) { batch.set<el::depth_test>(true); });
    ASSERT_TRUE(ordered());
    draw(1, [](Batch& batch) { batch.set<el::depth_test>(false); });
    const Pixels last_wins = picture();
    node_.node->orders_triangles = false;
    draw(1);
    EXPECT_EQ(count_different(last_wins, picture()), 0u) << "a copy is there, and is not drawn with";
}

TEST_F(IndexOrdersTest, AShaderThatCountsTrianglesKeepsTheirOrder) {
    const glapi::ProgramDefinition definition{
        {{GL_VERTEX_SHADER, true, "#version 150 compatibility\nvoid main() { gl_Position = gl_Vertex; }"},
         {GL_FRAGMENT_SHADER, true,
          "#version 150 compatibility\nvoid main() { gl_FragColor = vec4(fract(float(gl_PrimitiveID) / 7.0)); }"}},
        {},
        {}};
    Batch batch;
    pack::ProgramLink(batch.buffer(), RequestId(5), kProgram, encode(definition));
    batch.set<el::current_program>(kProgram.value);
    session_->expect_run(batch);
    const auto reflection = glapi::decode_reflection(session_->replies[RequestId(5)]);
    ASSERT_TRUE(reflection && reflection->linked);
    draw(2 * kWait);
    EXPECT_FALSE(ordered());
}

TEST_F(IndexOrdersTest, ANodeThatIsNotToldToOrdersNothing) {
    node_.node->orders_triangles = false;
    draw(2 * kWait);
    EXPECT_FALSE(ordered());
}

}  // namespace
}  // namespace wall::tileserver::test
