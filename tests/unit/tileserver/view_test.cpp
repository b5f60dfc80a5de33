// SPDX-License-Identifier: MIT
// Tiles that look elsewhere: what a program draws by a camera is seen there as plain Mesa draws it by that view's own
// matrix, whatever places the vertices.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "common/glapi/assembly_format.h"
#include "common/glapi/program_format.h"
#include "common/glstate/pieces.h"
#include "common/glstate/raster_place.h"
#include "common/glstate/vertex_input.h"
#include "common/glstate/view_change.h"
#include "tests/unit/tileserver/test_node.h"
#include "tileserver/objects/assembly_position.h"

namespace wall::tileserver::test {
namespace {

using glstate::Mat4;
using ::testing::HasSubstr;

constexpr int kWidth = 120, kHeight = 90;
constexpr geom::Rect kPart{0, 0, kWidth, kHeight};
constexpr SurfaceId kSurface{1};
constexpr ClientName kProgram{21}, kVertices{22}, kInput{23}, kPieces{24};
constexpr std::uint32_t kSlots = 3;  // 0 and 1 look elsewhere, 2 does not

/// 90 degrees wide, from 0.5 to 50.
const Mat4 kCamera{1, 0, 0, 0, 0, 4.0f / 3, 0, 0, 0, 0, -50.5f / 49.5f, -1, 0, 0, -50 / 49.5f, 0};
const Mat4 kModelview{0.8f, 0, 0.6f, 0, 0, 1, 0, 0, -0.6f, 0, 0.8f, 0, 0.5f, -0.25f, -2, 1};

struct Vertex {
    float x, y, z;
};

/// Triangles all around the eye.
std::vector<Vertex> ring() {
    std::vector<Vertex> out;
    constexpr int kCount = 40;
    for (int i = 0; i < kCount; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / kCount, next = angle + 0.1f;
        const float height = 0.1f * static_cast<float>(i % 7) - 0.5f;
        out.push_back({4 * std::sin(angle), height, -4 * std::cos(angle)});
        out.push_back({4 * std::sin(next), height, -4 * std::cos(next)});
        out.push_back({3 * std::sin(angle), height + 0.8f, -3 * std::cos(angle)});
    }
    return out;
}

class TilesThatLookElsewhere : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        for (std::uint32_t slot = 0; slot < kSlots; ++slot)
            node_.node->tiles.push_back({slot, {static_cast<int>(slot) * kWidth, 0, kWidth, kHeight}, {}});
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(kWidth, kHeight, kWhole);
        place(std::vector{view_of(0), view_of(1)});
    }
    static geom::EyeView view_of(std::uint32_t slot) {
        return {geom::view_of_angles(slot == 0 ? 70 : -120, 5, 3, 80, 60)};
    }
    static std::vector<std::byte> bytes_of(const std::vector<geom::EyeView>& views) {
        std::vector<std::byte> bytes;
        for (std::uint32_t slot = 0; slot < views.size(); ++slot) {
            const auto values = geom::values_of(views[slot]);
            const auto add = [&](const auto& value) {
                const auto raw = std::as_bytes(std::span(&value, 1));
                bytes.insert(bytes.end(), raw.begin(), raw.end());
            };
            add(slot);
            add(values);
        }
        return bytes;
    }
    void place(const std::vector<geom::EyeView>& views, const geom::Rect& rect = kWhole) {
        Batch batch;
        pack::SurfaceViews(batch.buffer(), kSurface, bytes_of(views));
        pack::SurfacePlace(batch.buffer(), kSurface, ++version_, kWidth, kHeight, rect.x, rect.y,
                           static_cast<std::uint32_t>(rect.width), static_cast<std::uint32_t>(rect.height), 0);
        session_->expect_run(batch);
    }
    /// Clears the tiles, then draws with these matrices.
    template <class Draw>
    void draw(Batch& batch, const Mat4& projection, const Mat4& modelview, Draw&& pack_draw) {
        batch.set<el::projection>(projection).set<el::modelview>(modelview);
        batch.block((1u << kSlots) - 1, [&](auto& b) {
            pack::Clear(b, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            pack_draw(b);
        });
        session_->expect_run(batch);
    }
    void pack_ring(wire::PackBuffer& b) const {
        pack::Begin(b, GL_TRIANGLES);
        for (std::size_t i = 0; i < ring_.size(); ++i) {
            pack::Color3f(b, static_cast<float>(i % 3) / 2, static_cast<float>(i % 5) / 4, 1);
            pack::Vertex3f(b, ring_[i].x, ring_[i].y, ring_[i].z);
        }
        pack::End(b);
    }
    void link(const char* vertex, const std::vector<std::string>& cameras = {}) {
        glapi::ProgramDefinition definition{
            {{GL_VERTEX_SHADER, true, vertex}, {GL_FRAGMENT_SHADER, true, "void main() { gl_FragColor = gl_Color; }"}},
            {},
            {}};
        definition.cameras = cameras;
        Batch batch;
        pack::ProgramLink(batch.buffer(), RequestId(5), kProgram, encode(definition));
        batch.set<el::current_program>(kProgram.value);
        session_->expect_run(batch);
        const auto reflection = glapi::decode_reflection(session_->replies[RequestId(5)]);
        ASSERT_TRUE(reflection && reflection->linked);
        ASSERT_EQ(reflection->position.known(), cameras.empty());
        uniforms_ = *glapi::number_uniforms(reflection->uniforms);
    }
    /// An assembly program, with what a compiler says of its position.
    void use_assembly(const std::string& placing) {
        const std::string text = "!!ARBvp1.0\n" + placing + "MOV result.color, vertex.color;\nEND";
        const AssemblyPosition found = recognise_assembly_position(text);
        ASSERT_TRUE(found.program.known()) << found.reason;
        Batch batch;
        pack::AssemblyDefine(batch.buffer(), kProgram, GL_VERTEX_PROGRAM_ARB,
                             encode(glapi::AssemblyDefinition{text, found.invariant, found.program}));
        batch.set<el::vertex_program>(kProgram.value).set<el::vertex_program_enabled>(1);
        session_->expect_run(batch);
    }
    void set_matrix(Batch& batch, const char* name, const Mat4& matrix) {
        const auto found = std::ranges::find(uniforms_, name, &glapi::UniformName::name);
        ASSERT_NE(found, uniforms_.end()) << name;
        pack::Uniform(batch.buffer(), kProgram, found->location, GL_FLOAT_MAT4, 1, std::as_bytes(std::span(matrix)));
    }
    /// What plain Mesa draws by these matrices: the ring, or what `draw` does with it.
    Pixels drawn_by(const Mat4& projection, const Mat4& modelview) {
        return drawn_by(projection, modelview, [this](const Gl& gl) {
            gl.Begin(GL_TRIANGLES);
            for (std::size_t i = 0; i < ring_.size(); ++i) {
                gl.Color3f(static_cast<float>(i % 3) / 2, static_cast<float>(i % 5) / 4, 1);
                gl.Vertex3f(ring_[i].x, ring_[i].y, ring_[i].z);
            }
            gl.End();
        });
    }
    template <class Draw>
    Pixels drawn_by(const Mat4& projection, const Mat4& modelview, Draw&& draw) {
        Pixels pixels;
        {
            ReferenceWindow window(kWidth, kHeight);
            const Gl& gl = window.gl();
            gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
            gl.MatrixMode(GL_PROJECTION);
            gl.LoadMatrixf(projection.data());
            gl.MatrixMode(GL_MODELVIEW);
            gl.LoadMatrixf(modelview.data());
            draw(gl);
            pixels = window.read();
        }
        node_.make_current();
        return pixels;
    }
    static Mat4 seen(std::uint32_t slot, const Mat4& camera) { return seen(view_of(slot), camera); }
    static Mat4 seen(const geom::EyeView& view, const Mat4& camera) {
        const auto change = glstate::view_change(view, camera);
        EXPECT_TRUE(change.has_value());
        return glstate::product(*change, camera);
    }
    /// Each of the two shows the ring as its view has it: `but` pixels may be rounded otherwise.
    void expect_views(std::size_t but = 0) {
        for (const std::uint32_t slot : {0u, 1u}) {
            const Pixels wanted = drawn_by(seen(slot, kCamera), kModelview);
            EXPECT_LE(count_different(wanted, session_->read(slot, kPart)), but) << "slot " << slot;
            EXPECT_GT(count_different(wanted, drawn_by(kCamera, kModelview)), 500u) << "it tells them apart";
        }
    }

    void draw_in_pieces();

    static constexpr geom::Rect kWhole{0, 0, kSlots* kWidth, kHeight};
    static constexpr std::size_t kRounded = 4;  ///< pixels, where a shader multiplies in another order
    TestNode node_;
    std::optional<TestSession> session_;
    std::uint32_t version_ = 1;
    std::vector<glapi::UniformName> uniforms_;
    const std::vector<Vertex> ring_ = ring();
};

TEST_F(TilesThatLookElsewhere, LabelsLieWhereTheyAreSeen) {
    constexpr std::array<GLubyte, 8> kLetter{0xff, 0x81, 0xbd, 0xa5, 0xa5, 0xbd, 0x81, 0xff};
    constexpr std::array<GLubyte, 3 * 2 * 4> kImage{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255,
                                                    9,   9, 0, 255, 0, 200, 9, 255, 7, 7, 255, 255};
    constexpr float kMove = 9.25f;
    std::vector<Vertex> places;
    for (int i = 0; i < 40; ++i)
        places.push_back({3 * std::sin(0.31f * static_cast<float>(i)), 0.5f * std::cos(static_cast<float>(i)),
                          -3 * std::cos(0.31f * static_cast<float>(i))});
    // What plain Mesa draws by a view's own matrices.
    const auto wanted = [&](const Mat4& projection) {
        return drawn_by(projection, kModelview, [&](const Gl& gl) {
            gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
            gl.PixelZoom(2, 3);
            for (const Vertex& at : places) {
                gl.RasterPos4f(at.x, at.y, at.z, 1);
                for (int letter = 0; letter < 2; ++letter) gl.Bitmap(8, 8, 1, 2, kMove, 0, kLetter.data());
                gl.DrawPixels(3, 2, GL_RGBA, GL_UNSIGNED_BYTE, kImage.data());
            }
        });
    };
    glstate::State state;  // the client's
    state.matrix.projection = kCamera;
    state.window.viewport = {0, 0, kWidth, kHeight};
    const auto add_label = [&](Batch& batch, const Vertex& at) {
        const auto clip =
            glstate::project(glstate::Projection{.clip_from_object = glstate::multiply(kCamera, kModelview)}, at.x,
                             at.y, at.z, 1)
                .clip;
        auto position = glstate::window_position(state, clip);
        batch.set<el::raster_position_valid>(glstate::in_view_volume(state, clip))
            .set<el::raster_clip>(glstate::raster_clip(state, clip));
        const auto draw = [&](auto&& pack_image) {
            batch.set<el::raster_position>(position);
            batch.block((1u << kSlots) - 1, pack_image);
            position[0] += kMove;
        };
        for (int letter = 0; letter < 2; ++letter)
            draw([&](auto& b) { pack::Bitmap(b, 8, 8, 1, 2, 0, 0, std::as_bytes(std::span(kLetter))); });
        draw([&](auto& b) { pack::DrawPixels(b, 3, 2, GL_RGBA, GL_UNSIGNED_BYTE, std::as_bytes(std::span(kImage))); });
    };
    const auto draw_labels = [&] {
        Batch batch;
        batch.set<el::projection>(kCamera).set<el::modelview>(kModelview).set<el::pixel_zoom>({2, 3});
        batch.block((1u << kSlots) - 1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT); });
        for (const Vertex& at : places) add_label(batch, at);
        session_->expect_run(batch);
    };
    draw_labels();
    const Pixels own = wanted(kCamera);
    for (const std::uint32_t slot : {0u, 1u}) {
        const Pixels there = wanted(seen(slot, kCamera));
        EXPECT_EQ(count_different(there, session_->read(slot, kPart)), 0u) << "slot " << slot;
        EXPECT_GT(count_different(there, own), 300u) << "it tells them apart";
    }
    place({}, {2 * kWidth, 0, kWidth, kHeight});
    draw_labels();
    EXPECT_EQ(count_different(own, session_->read(2, kPart)), 0u) << "the program's own picture";
}

TEST_F(TilesThatLookElsewhere, FixedFunctionIsSeenThroughThem) {
    Batch batch;
    draw(batch, kCamera, kModelview, [&](auto& b) { pack_ring(b); });
    expect_views();
}

TEST_F(TilesThatLookElsewhere, MatricesAndViewsChangeInAnyOrder) {
    Batch first, second;
    draw(first, Mat4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, kModelview, [&](auto& b) { pack_ring(b); });
    draw(second, kCamera, kModelview, [&](auto& b) { pack_ring(b); });
    expect_views();
    place({{geom::view_of_angles(10, 0, 0, 50, 40)}, {geom::view_of_angles(20, 0, 0, 50, 40)}});
    place({view_of(0), view_of(1)});
    Batch third;
    draw(third, kCamera, kModelview, [&](auto& b) { pack_ring(b); });
    expect_views();
}

TEST_F(TilesThatLookElsewhere, WhatHasNoPerspectiveIsTheSameOnEach) {
    const Mat4 flat{0.2f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, -0.1f, 0, 0, 0, 0, 1};
    Batch batch;
    draw(batch, flat, kModelview, [&](auto& b) { pack_ring(b); });
    const Pixels wanted = drawn_by(flat, kModelview);
    for (const std::uint32_t slot : {0u, 1u}) EXPECT_EQ(count_different(wanted, session_->read(slot, kPart)), 0u);
}

TEST_F(TilesThatLookElsewhere, OthersShowTheirPartOfThePicture) {
    place({}, {2 * kWidth, 0, kWidth, kHeight});
    Batch batch;
    draw(batch, kCamera, kModelview, [&](auto& b) { pack_ring(b); });
    EXPECT_EQ(count_different(drawn_by(kCamera, kModelview), session_->read(2, kPart)), 0u);
}

TEST_F(TilesThatLookElsewhere, AShaderWithMatricesOfFixedFunctionIsSeenThroughThem) {
    link("void main() { gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex; gl_FrontColor = gl_Color; }");
    Batch batch;
    draw(batch, kCamera, kModelview, [&](auto& b) { pack_ring(b); });
    expect_views(kRounded);
}

constexpr const char* kByRows =
    "PARAM mvp[4] = { state.matrix.mvp };\n"
    "DP4 result.position.x, mvp[0], vertex.position; DP4 result.position.y, mvp[1], vertex.position;\n"
    "DP4 result.position.z, mvp[2], vertex.position; DP4 result.position.w, mvp[3], vertex.position;\n";

TEST_F(TilesThatLookElsewhere, AssemblyProgramsWithMatricesOfFixedFunctionAreSeenThroughThem) {
    use_assembly("OPTION ARB_position_invariant;\n");
    Batch invariant;
    draw(invariant, kCamera, kModelview, [&](auto& b) { pack_ring(b); });
    expect_views(kRounded);
    use_assembly(kByRows);
    Batch by_rows;
    draw(by_rows, kCamera, kModelview, [&](auto& b) { pack_ring(b); });
    expect_views(kRounded);
}

TEST_F(TilesThatLookElsewhere, AShadersOwnProjectionIsSeenThroughThem) {
    link(
        "uniform mat4 projection, model; void main() { gl_Position = projection * model * gl_Vertex; gl_FrontColor = "
        "gl_Color; }");
    const Mat4 nothing{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    Batch batch;
    set_matrix(batch, "model", kModelview);
    set_matrix(batch, "projection", kCamera);
    draw(batch, nothing, nothing, [&](auto& b) { pack_ring(b); });
    expect_views(kRounded);
    // And when it is told again between two draws.
    Batch other, again;
    set_matrix(other, "projection", nothing);
    draw(other, nothing, nothing, [&](auto& b) { pack_ring(b); });
    set_matrix(again, "projection", kCamera);
    draw(again, nothing, nothing, [&](auto& b) { pack_ring(b); });
    expect_views(kRounded);
}

TEST_F(TilesThatLookElsewhere, AShaderWithOneMatrixForAllIsSeenThroughThem) {
    link("uniform mat4 all; void main() { gl_Position = all * gl_Vertex; gl_FrontColor = gl_Color; }");
    const Mat4 nothing{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    Batch batch;
    set_matrix(batch, "all", glstate::multiply(kCamera, kModelview));
    draw(batch, nothing, nothing, [&](auto& b) { pack_ring(b); });
    expect_views(kRounded);
}

TEST_F(TilesThatLookElsewhere, AShaderThatIsNotFollowedIsSeenThroughTheCameraThatIsNamed) {
    constexpr const char* kByNumber =
        "uniform mat4 cameras[2]; uniform mat4 models[2]; void main() { int which = int(gl_Color.b);\n"
        "gl_Position = cameras[1] * models[which] * gl_Vertex; gl_FrontColor = gl_Color; }";
    const Mat4 nothing{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    link(kByNumber, {"nowhere", "cameras[1]"});
    const auto location_of = [&](const char* name) {
        return std::ranges::find(uniforms_, name, &glapi::UniformName::name)->location;
    };
    const auto set = [&](Batch& batch, std::uint32_t location, const Mat4& matrix) {
        pack::Uniform(batch.buffer(), kProgram, location, GL_FLOAT_MAT4, 1, std::as_bytes(std::span(matrix)));
    };
    Batch batch, again;
    set(batch, location_of("models") + 1, kModelview);
    set(batch, location_of("cameras") + 1, nothing);
    draw(batch, nothing, nothing, [&](auto& b) { pack_ring(b); });
    set(again, location_of("cameras") + 1, kCamera);
    draw(again, nothing, nothing, [&](auto& b) { pack_ring(b); });
    expect_views(kRounded);
}

TEST_F(TilesThatLookElsewhere, PiecesAreThoseThatTheViewSees) { draw_in_pieces(); }

TEST_F(TilesThatLookElsewhere, PiecesOfAnInvariantAssemblyProgramAre) {
    use_assembly("OPTION ARB_position_invariant;\n");
    draw_in_pieces();
}

TEST_F(TilesThatLookElsewhere, PiecesOfAnAssemblyProgramByRowsAre) {
    use_assembly(kByRows);
    draw_in_pieces();
}

/// The ring in pieces is the same as whole, and each tile draws some of them.
void TilesThatLookElsewhere::draw_in_pieces() {
    Batch batch;
    auto& b = batch.buffer();
    pack::BufferData(b, kVertices, static_cast<std::uint32_t>(ring_.size() * sizeof(Vertex)), GL_STATIC_DRAW);
    pack::BufferSubData(b, kVertices, 0, std::as_bytes(std::span(ring_)));
    const glstate::VertexInputDefinition input{{},
                                               {{.place = glstate::kPositionArray,
                                                 .buffer = kVertices,
                                                 .stride = sizeof(Vertex),
                                                 .type = GL_FLOAT,
                                                 .size = 3}}};
    pack::VertexInput(b, kInput, glstate::encode(input));
    constexpr std::uint32_t kStep = 12;
    std::vector<glstate::PieceBox> pieces;
    for (std::size_t first = 0; first < ring_.size(); first += kStep) {
        geom::Box box;
        for (std::size_t i = first; i < first + kStep; ++i) box.add(_mm_setr_ps(ring_[i].x, ring_[i].y, ring_[i].z, 1));
        pieces.push_back(glstate::piece_box(box));
    }
    pack::DrawPieces(b, kPieces, kStep, 0, std::as_bytes(std::span(pieces)));
    const auto count = static_cast<std::int32_t>(ring_.size());
    const std::uint64_t counted_before = session_->session.work.array_elements;
    draw(batch, kCamera, kModelview,
         [&](auto& block) { pack::DrawArrays(block, kInput, kPieces, GL_TRIANGLES, 0, count); });
    std::vector<Pixels> in_pieces;
    for (const std::uint32_t slot : {0u, 1u}) in_pieces.push_back(session_->read(slot, kPart));
    const std::uint64_t counted = session_->session.work.array_elements - counted_before;
    EXPECT_LT(counted, kSlots * ring_.size()) << "each tile draws some of them";
    Batch whole;
    draw(whole, kCamera, kModelview, [&](auto& block) { pack::DrawArrays(block, kInput, {}, GL_TRIANGLES, 0, count); });
    for (const std::uint32_t slot : {0u, 1u})
        EXPECT_EQ(count_different(in_pieces[slot], session_->read(slot, kPart)), 0u) << slot;
}

/// Where the window lies, not all over the tile: each eye sees the same part of the picture, from beside the other.
TEST_F(TilesThatLookElsewhere, AnEyeSeesItsPartOfThePictureFromBeside) {
    const std::vector<geom::EyeView> eyes{{.parallax = {-0.1f, 3}}, {.parallax = {0.1f, 3}}};
    // The window is as large as a tile and lies with its right half on the first, with its left one on the second.
    place(eyes, {kWidth / 2, 0, kWidth, kHeight});
    Batch batch;
    draw(batch, kCamera, kModelview, [&](auto& b) { pack_ring(b); });
    for (const std::uint32_t slot : {0u, 1u}) {
        const geom::Rect half{slot == 0 ? 0 : kWidth / 2, 0, kWidth / 2, kHeight};
        const auto part = [&](const Mat4& projection) {
            const Pixels all = drawn_by(projection, kModelview);
            Pixels out;
            for (int y = 0; y < kHeight; ++y)
                out.insert(out.end(), all.begin() + (y * kWidth + half.x) * 4,
                           all.begin() + (y * kWidth + half.x + half.width) * 4);
            return out;
        };
        const Pixels wanted = part(seen(eyes[slot], kCamera));
        const Pixels shown = session_->read(slot, {slot == 0 ? 0 : half.x, 0, half.width, kHeight});
        EXPECT_LE(count_different(wanted, shown), kRounded) << "slot " << slot;
        EXPECT_GT(count_different(wanted, part(kCamera)), 200u) << "it tells them apart";
    }
}

TEST_F(TilesThatLookElsewhere, WrongViewsAreRefused) {
    const auto refusal = [&](std::span<const std::byte> bytes) {
        session_.emplace(*node_.node, SessionId(2));  // what was refused once stays so
        session_->open_surface(kWidth, kHeight, kWhole);
        Batch batch;
        pack::SurfaceViews(batch.buffer(), kSurface, bytes);
        const auto done = session_->run(batch);
        return done ? "" : done.error().message;
    };
    auto bytes = bytes_of({view_of(0)});
    EXPECT_EQ(refusal(bytes), "");
    EXPECT_THAT(refusal(std::span(bytes).first(20)), HasSubstr("no whole number of views"));
    geom::EyeView folded = view_of(0), far_apart = view_of(0);
    folded.elsewhere->top = folded.elsewhere->bottom;
    far_apart.parallax = {2, 1};
    EXPECT_THAT(refusal(bytes_of({far_apart})), HasSubstr("eyes that are more than a picture apart"));
    EXPECT_THAT(refusal(bytes_of({folded})), HasSubstr("edges that leave nothing between them"));
    const std::uint32_t slot = 63;
    std::memcpy(bytes.data(), &slot, sizeof slot);
    EXPECT_THAT(refusal(bytes), HasSubstr("a view of no tile"));
}

}  // namespace
}  // namespace wall::tileserver::test
