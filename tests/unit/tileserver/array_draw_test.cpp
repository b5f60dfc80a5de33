// SPDX-License-Identifier: MIT
// Draws from buffers that the node keeps, compared with plain Mesa drawing from its own.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <utility>

#include "common/glapi/program_format.h"
#include "common/glstate/pieces.h"
#include "common/glstate/vertex_input.h"
#include "tests/unit/tileserver/test_node.h"
#include "tileserver/execute/executor.h"

namespace wall::tileserver::test {
namespace {

using glstate::InputArray;
using ::testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 120;
constexpr geom::Rect kWindow{0, 0, kWidth, kHeight};
constexpr ClientName kVertices(11), kIndices(12), kInput(13), kPieces(14);

struct Vertex {
    float x, y, z;
    std::uint8_t color[4];
};

/// A wavy grid over the window.
struct Grid {
    static constexpr int kColumns = 40, kRows = 30;
    std::vector<Vertex> vertices;
    std::vector<std::uint16_t> indices;  ///< of triangles
    Grid() {
        for (int row = 0; row <= kRows; ++row)
            for (int column = 0; column <= kColumns; ++column) add(column, row);
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column)
                for (const auto& [c, r] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 1}})
                    indices.push_back(static_cast<std::uint16_t>((row + r) * (kColumns + 1) + column + c));
    }
    std::int32_t count() const { return static_cast<std::int32_t>(indices.size()); }

private:
    void add(int column, int row) {
        const float x = 1.8f * static_cast<float>(column) / kColumns - 0.9f,
                    y = 1.8f * static_cast<float>(row) / kRows - 0.9f;
        const auto shade = [](int i, int step) { return static_cast<std::uint8_t>(i * step % 256); };
        vertices.push_back(
            {x, y, 0.3f * std::sin(5 * x), {shade(column, 37), shade(row, 53), shade(row + column, 11), 255}});
    }
};

class ArrayDrawTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, kWindow}};
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(kWidth, kHeight, kWindow);
    }
    void define_buffer(wire::PackBuffer& b, ClientName name, std::span<const std::byte> content) {
        pack::BufferData(b, name, static_cast<std::uint32_t>(content.size()), GL_STATIC_DRAW);
        pack::BufferSubData(b, name, 0, content);
    }
    void define(wire::PackBuffer& b) {
        define_buffer(b, kVertices, std::as_bytes(std::span(grid_.vertices)));
        define_buffer(b, kIndices, std::as_bytes(std::span(grid_.indices)));
        pack::VertexInput(b, kInput, glstate::encode(input_));
    }
    /// One box for each 12 elements, so that a small grid has many.
    std::vector<glstate::PieceBox> boxes(std::uint32_t step) const {
        std::vector<glstate::PieceBox> out;
        for (std::size_t first = 0; first < grid_.indices.size(); first += step) {
            geom::Box box;
            for (std::size_t i = first; i < std::min<std::size_t>(first + step, grid_.indices.size()); ++i) {
                const Vertex& v = grid_.vertices[grid_.indices[i]];
                box.add(_mm_setr_ps(v.x, v.y, v.z, 1));
            }
            out.push_back(glstate::piece_box(box));
        }
        return out;
    }
    /// What plain Mesa makes of it.
    Pixels reference() {
        Pixels pixels;
        {
            ReferenceWindow window(kWidth, kHeight);
            const Gl& gl = window.gl();
            gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            gl.VertexPointer(3, GL_FLOAT, sizeof(Vertex), grid_.vertices.data());
            gl.ColorPointer(4, GL_UNSIGNED_BYTE, sizeof(Vertex), grid_.vertices[0].color);
            gl.EnableClientState(GL_VERTEX_ARRAY);
            gl.EnableClientState(GL_COLOR_ARRAY);
            gl.DrawElements(GL_TRIANGLES, grid_.count(), GL_UNSIGNED_SHORT, grid_.indices.data());
            pixels = window.read();
        }
        node_.make_current();
        return pixels;
    }
    /// Clears, then draws.
    template <class Draw>
    void draw(Batch& batch, Draw&& pack_draw) {
        batch.block(1, [&](auto& b) {
            pack::Clear(b, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            pack_draw(b);
        });
    }
    void expect_reference() { EXPECT_EQ(count_different(reference(), session_->read(0, kWindow)), 0u); }
    /// Why a draw is refused.
    template <class Draw>
    std::string refusal(Draw&& pack_draw) {
        Batch batch;
        define(batch.buffer());
        draw(batch, pack_draw);
        const auto done = session_->run(batch);
        return done ? "" : done.error().message;
    }

    TestNode node_;
    std::optional<TestSession> session_;
    Grid grid_;
    glstate::VertexInputDefinition input_{
        kIndices,
        {{.place = glstate::kPositionArray, .buffer = kVertices, .stride = sizeof(Vertex), .type = GL_FLOAT, .size = 3},
         {.place = static_cast<std::uint32_t>(glstate::Attribute::color),
          .buffer = kVertices,
          .offset = offsetof(Vertex, color),
          .stride = sizeof(Vertex),
          .type = GL_UNSIGNED_BYTE,
          .size = 4,
          .normalized = 1}}};
};

TEST_F(ArrayDrawTest, ElementsAreTheSameAsPlainMesas) {
    Batch batch;
    define(batch.buffer());
    draw(batch,
         [&](auto& b) { pack::DrawElements(b, kInput, {}, GL_TRIANGLES, grid_.count(), GL_UNSIGNED_SHORT, 0, 0); });
    session_->expect_run(batch);
    expect_reference();
}

TEST_F(ArrayDrawTest, IndicesMayComeAlong) {
    input_.indices = {};
    Batch batch;
    define(batch.buffer());
    draw(batch, [&](auto& b) {
        pack::DrawIndices(b, kInput, GL_TRIANGLES, GL_UNSIGNED_SHORT, 0, std::as_bytes(std::span(grid_.indices)));
    });
    session_->expect_run(batch);
    expect_reference();
}

TEST_F(ArrayDrawTest, PiecesTogetherAreTheWhole) {
    Batch batch;
    define(batch.buffer());
    const auto pieces = boxes(12);
    pack::DrawPieces(batch.buffer(), kPieces, 12, 0, std::as_bytes(std::span(pieces)));
    draw(batch, [&](auto& b) {
        pack::DrawElements(b, kInput, kPieces, GL_TRIANGLES, grid_.count(), GL_UNSIGNED_SHORT, 0, 0);
    });
    session_->expect_run(batch);
    expect_reference();
}

// A piece whose box lies off the tile is left out: here all but one lie there, by boxes that are not true.
TEST_F(ArrayDrawTest, APieceOffTheTileIsNotDrawn) {
    Batch batch;
    define(batch.buffer());
    auto pieces = boxes(12);
    for (std::size_t i = 1; i < pieces.size(); ++i) pieces[i] = {{5, 5, 0}, {6, 6, 0}};
    pack::DrawPieces(batch.buffer(), kPieces, 12, 0, std::as_bytes(std::span(pieces)));
    draw(batch, [&](auto& b) {
        pack::DrawElements(b, kInput, kPieces, GL_TRIANGLES, grid_.count(), GL_UNSIGNED_SHORT, 0, 0);
    });
    session_->expect_run(batch);
    const Pixels drawn = session_->read(0, kWindow);
    Batch alone;
    draw(alone, [&](auto& b) { pack::DrawElements(b, kInput, {}, GL_TRIANGLES, 12, GL_UNSIGNED_SHORT, 0, 0); });
    session_->expect_run(alone);
    EXPECT_EQ(count_different(session_->read(0, kWindow), drawn), 0u);
}

class PiecesOfAProgram : public ArrayDrawTest {
protected:
    static constexpr ClientName kProgram{21};
    static constexpr RequestId kLink{5};

    /// The program is linked by the driver, and asked about as a client does it.
    glapi::ProgramReflection link(const char* vertex) {
        const glapi::ProgramDefinition definition{
            {{GL_VERTEX_SHADER, true, vertex}, {GL_FRAGMENT_SHADER, true, "void main() { gl_FragColor = gl_Color; }"}},
            {},
            {}};
        Batch batch;
        pack::ProgramLink(batch.buffer(), kLink, kProgram, encode(definition));
        session_->expect_run(batch);
        const auto reflection = glapi::decode_reflection(session_->replies[kLink]);
        EXPECT_TRUE(reflection && reflection->linked) << (reflection ? reflection->log : "no answer");
        return reflection.value_or(glapi::ProgramReflection());
    }
    /// How many elements are drawn, with boxes of which all but the first lie at (5, 5, 0), and a shift by the shader.
    std::uint64_t drawn(std::array<float, 4> shift) {
        Batch batch;
        if (!std::exchange(defined_, true)) define(batch.buffer());
        auto pieces = boxes(12);
        for (std::size_t i = 1; i < pieces.size(); ++i) pieces[i] = {{5, 5, 0}, {5.5f, 5.5f, 0}};
        pack::DrawPieces(batch.buffer(), kPieces, 12, 0, std::as_bytes(std::span(pieces)));
        pack::Uniform(batch.buffer(), kProgram, 0, GL_FLOAT_VEC4, 1, std::as_bytes(std::span(shift)));
        batch.set<el::current_program>(kProgram.value);
        draw(batch, [&](auto& b) {
            pack::DrawElements(b, kInput, kPieces, GL_TRIANGLES, grid_.count(), GL_UNSIGNED_SHORT, 0, 0);
        });
        const std::uint64_t before = session_->session.work.array_elements;
        session_->expect_run(batch);
        return session_->session.work.array_elements - before;
    }

private:
    bool defined_ = false;
};

constexpr const char* kShifting =
    "uniform vec4 shift; void main() { gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex + shift;\n"
    "  gl_FrontColor = gl_Color; }";

TEST_F(PiecesOfAProgram, LieWhereItsUniformsPutThem) {
    const auto all = static_cast<std::uint64_t>(grid_.count());
    const glapi::ProgramReflection reflection = link(kShifting);
    EXPECT_EQ(reflection.position.attribute, "gl_Vertex");
    EXPECT_EQ(drawn({}), 12u);
    EXPECT_EQ(drawn({-5, -5, 0, 0}), all - 12);
    EXPECT_EQ(drawn({-50, 0, 0, 0}), 0u);
    Batch batch;  // and where the matrices do
    batch.set<el::modelview>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 50, 0, 0, 1});
    session_->expect_run(batch);
    EXPECT_EQ(drawn({}), 0u);
    EXPECT_EQ(drawn({-50, 0, 0, 0}), 12u);
}

TEST_F(PiecesOfAProgram, AreAllDrawnWhereItPutsThemAnywhere) {
    link(
        "uniform vec4 shift; void main() { gl_Position = gl_Vertex * gl_Vertex.w * gl_Vertex.w + shift;\n"
        "  gl_FrontColor = gl_Color; }");
    EXPECT_EQ(drawn({}), static_cast<std::uint64_t>(grid_.count()));
}

TEST_F(PiecesOfAProgram, AreKnownToANodeThatWasNotAsked) {
    const glapi::ProgramReflection reflection = link(kShifting);
    glapi::ProgramDefinition definition{{{GL_VERTEX_SHADER, true, kShifting}}, {}, {{1, "shift"}}};
    const auto link_again = [&] {
        Batch batch;
        pack::ProgramLink(batch.buffer(), RequestId(), kProgram, encode(definition));
        session_->expect_run(batch);
    };
    link_again();
    EXPECT_EQ(drawn({}), static_cast<std::uint64_t>(grid_.count()));
    definition.position = reflection.position;
    link_again();
    EXPECT_EQ(drawn({}), 12u);
    EXPECT_EQ(drawn({-50, 0, 0, 0}), 0u);
}

TEST_F(ArrayDrawTest, AChangedBufferIsDrawnAsItIsNow) {
    Batch batch;
    define(batch.buffer());
    for (Vertex& v : grid_.vertices) v.x = -v.x;
    pack::BufferSubData(batch.buffer(), kVertices, 0, std::as_bytes(std::span(grid_.vertices)));
    draw(batch,
         [&](auto& b) { pack::DrawElements(b, kInput, {}, GL_TRIANGLES, grid_.count(), GL_UNSIGNED_SHORT, 0, 0); });
    session_->expect_run(batch);
    expect_reference();
}

TEST_F(ArrayDrawTest, TheCurrentColorIsThatOfBefore) {
    Batch batch;
    define(batch.buffer());
    batch.set<el::color>({0.25f, 0.5f, 0.75f, 1});
    draw(batch, [&](auto& b) {
        pack::DrawElements(b, kInput, {}, GL_TRIANGLES, grid_.count(), GL_UNSIGNED_SHORT, 0, 0);
        pack::Begin(b, GL_POINTS);
        pack::Vertex2f(b, -0.99f, -0.99f);
        pack::End(b);
    });
    session_->expect_run(batch);
    const Pixels drawn = session_->read(0, {0, 0, 1, 1});
    EXPECT_EQ(drawn[0], 64);
    EXPECT_EQ(drawn[2], 191);
}

// All of the grid by a restart between any two triangles of a strip.
TEST_F(ArrayDrawTest, PrimitivesBeginAnewWhereTheIndexSaysSo) {
    std::vector<std::uint16_t> indices;
    for (std::size_t i = 0; i < grid_.indices.size(); i += 3) {
        indices.insert(indices.end(), grid_.indices.begin() + static_cast<std::ptrdiff_t>(i),
                       grid_.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
        indices.push_back(0xffff);
    }
    const auto count = static_cast<std::int32_t>(indices.size());
    Batch batch;
    define(batch.buffer());
    define_buffer(batch.buffer(), kIndices, std::as_bytes(std::span(indices)));
    draw(batch, [&](auto& b) {
        pack::DrawElementsInstanced(b, kInput, GL_TRIANGLE_STRIP, count, GL_UNSIGNED_SHORT, 0, 0, 1, 1, 0xffff);
    });
    session_->expect_run(batch);
    expect_reference();
    EXPECT_EQ(session_->session.work.array_elements, indices.size());
    Batch next;  // no other draw knows of it
    draw(next, [&](auto& b) {
        pack::DrawIndicesInstanced(b, kInput, GL_TRIANGLES, GL_UNSIGNED_SHORT, 0, 2, 0, 0,
                                   std::as_bytes(std::span(grid_.indices)));
    });
    EXPECT_FALSE(session_->run(next)) << "the input has indices";
}

TEST_F(ArrayDrawTest, InstancesAndTheirArrays) {
    input_.indices = {};
    const float shifts[] = {-9, 0, 0};  // the first instance is not to be seen
    input_.arrays.push_back({.place = static_cast<std::uint32_t>(glstate::Attribute::vertex_attrib) + 3,
                             .buffer = kIndices,
                             .type = GL_FLOAT,
                             .size = 1,
                             .divisor = 1});
    Batch batch;
    define(batch.buffer());
    define_buffer(batch.buffer(), kIndices, std::as_bytes(std::span(shifts)));
    draw(batch, [&](auto& b) {
        pack::DrawIndicesInstanced(b, kInput, GL_TRIANGLES, GL_UNSIGNED_SHORT, 0, 3, 0, 0,
                                   std::as_bytes(std::span(grid_.indices)));
    });
    session_->expect_run(batch);
    expect_reference();
    EXPECT_EQ(session_->session.work.array_elements, 3 * grid_.indices.size());
}

TEST_F(ArrayDrawTest, RefusesFewerThanNoInstances) {
    EXPECT_THAT(refusal([&](auto& b) { pack::DrawArraysInstanced(b, kInput, GL_TRIANGLES, 0, 3, -1); }),
                HasSubstr("fewer than no instances"));
}
TEST_F(ArrayDrawTest, RefusesMoreElementsThanADrawMayHave) {
    EXPECT_THAT(refusal([&](auto& b) { pack::DrawArraysInstanced(b, kInput, GL_TRIANGLES, 0, 1 << 20, 1 << 20); }),
                HasSubstr("more elements than a draw may have"));
}
TEST_F(ArrayDrawTest, RefusesInstancesOfElementsBeforeTheFirst) {
    EXPECT_THAT(refusal([&](auto& b) { pack::DrawArraysInstanced(b, kInput, GL_TRIANGLES, -1, 3, 1); }),
                HasSubstr("no such elements"));
}
TEST_F(ArrayDrawTest, OfNoInstancesNothingIsDrawn) {
    EXPECT_EQ(refusal([&](auto& b) { pack::DrawArraysInstanced(b, kInput, GL_TRIANGLES, 0, 3, 0); }), "");
    EXPECT_EQ(session_->session.work.array_elements, 0u);
}

TEST_F(ArrayDrawTest, ADrawNeedsNoArraysAndNoBuffers) {
    Batch batch;
    pack::VertexInput(batch.buffer(), kInput, glstate::encode(glstate::VertexInputDefinition{}));
    draw(batch, [](auto& b) { pack::DrawArrays(b, kInput, {}, GL_POINTS, 5, 7); });
    session_->expect_run(batch);
    EXPECT_EQ(session_->session.work.gl_errors, 0u);
    EXPECT_EQ(session_->session.work.array_elements, 7u);
}
TEST_F(ArrayDrawTest, DrawsNothingWhoseIndicesReachBehindTheirBuffer) {
    Batch batch;
    define(batch.buffer());
    draw(batch,
         [&](auto& b) { pack::DrawElements(b, kInput, {}, GL_TRIANGLES, grid_.count() + 1, GL_UNSIGNED_SHORT, 0, 0); });
    session_->expect_run(batch);
    const Pixels drawn = session_->read(0, kWindow);
    for (std::size_t i = 0; i < drawn.size(); i += 4) ASSERT_EQ(drawn[i], 0);
    EXPECT_EQ(session_->session.work.gl_errors, 1u);
}
TEST_F(ArrayDrawTest, RefusesIndicesBetweenTwoPlaces) {
    EXPECT_THAT(refusal([&](auto& b) { pack::DrawElements(b, kInput, {}, GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, 1, 0); }),
                HasSubstr("no such indices"));
}
TEST_F(ArrayDrawTest, RefusesAnInputThatThereIsNot) {
    EXPECT_THAT(refusal([&](auto& b) { pack::DrawArrays(b, ClientName(99), {}, GL_TRIANGLES, 0, 3); }),
                HasSubstr("there is no vertex input 99"));
}
TEST_F(ArrayDrawTest, RefusesAnObjectOfAnotherKind) {
    EXPECT_THAT(refusal([&](auto& b) { pack::DrawArrays(b, kVertices, {}, GL_TRIANGLES, 0, 3); }),
                HasSubstr("is a buffer, not a vertex input"));
}
TEST_F(ArrayDrawTest, RefusesPiecesOfAnotherDraw) {
    EXPECT_THAT(refusal([&](auto& b) {
                    pack::DrawElements(b, kInput, kPieces, GL_TRIANGLES, grid_.count(), GL_UNSIGNED_SHORT, 0, 0);
                }),
                HasSubstr("there is no piece table"));
}
TEST_F(ArrayDrawTest, RefusesModesThatThereAreNot) {
    EXPECT_THAT(refusal([&](auto& b) { pack::DrawArrays(b, kInput, {}, GL_PATCHES + 1, 0, 3); }),
                HasSubstr("no such primitive"));
}
TEST_F(ArrayDrawTest, RefusesToWriteBehindABuffersEnd) {
    Batch batch;
    define(batch.buffer());
    pack::BufferSubData(batch.buffer(), kIndices, static_cast<std::uint32_t>(grid_.indices.size() * 2 - 1),
                        std::as_bytes(std::span("xyz", 2)));
    const auto done = session_->run(batch);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("over the end"));
}

TEST_F(ArrayDrawTest, NothingIsLeftInTheDriver) {
    const DriverObjects before = *node_.driver->gl().objects;
    Batch batch;
    define(batch.buffer());
    draw(batch, [&](auto& b) { pack::DrawElements(b, kInput, {}, GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, 0, 0); });
    for (const ClientName name : {kVertices, kIndices, kInput}) pack::ObjectDelete(batch.buffer(), name);
    session_->expect_run(batch);
    EXPECT_TRUE(*node_.driver->gl().objects == before);
}

}  // namespace
}  // namespace wall::tileserver::test
