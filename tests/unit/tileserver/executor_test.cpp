// SPDX-License-Identifier: MIT
// What the executor draws, compared with the same commands given to plain Mesa directly.
#include "tileserver/execute/executor.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include "common/wire/whole_window.h"
#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr GLbitfield kColorDepth = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT;
constexpr geom::Rect kWindow{0, 0, kWidth, kHeight};

class ExecutorTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, kWindow}};
    }
    /// What plain Mesa makes of `draw`.
    template <class Draw>
    Pixels reference(Draw&& draw) {
        Pixels pixels;
        {
            ReferenceWindow window(kWidth, kHeight);
            draw(window.gl());
            pixels = window.read();
        }
        node_.make_current();
        return pixels;
    }
    void expect_same(const Pixels& expected, const Pixels& drawn) {
        const auto different = count_different(expected, drawn);
        EXPECT_EQ(different, 0u);
        if (different == 0) return;
        const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        write_ppm((name + "_expected.ppm").c_str(), expected, kWidth, kHeight);
        write_ppm((name + "_drawn.ppm").c_str(), drawn, kWidth, kHeight);
    }
    TestNode node_;
};

TEST_F(ExecutorTest, BeginsAgainWithNothingButItsWindows) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    const auto red = [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); };
    Batch before;
    before.set<el::clear_color>({1, 0, 0, 1}).block(1, red);
    pack::BufferData(before.buffer(), ClientName(7), 16, GL_STATIC_DRAW);
    session.expect_run(before);
    ASSERT_EQ(session.session.objects.size(), 1u);
    Batch again;
    pack::BeginAgain(again.buffer());
    session.expect_run(again);
    EXPECT_EQ(session.session.objects.size(), 0u);
    EXPECT_EQ(el::clear_color::ref(session.session.context(ContextId(1)).state), (glstate::Vec4{0, 0, 0, 0}));
    Batch behind;  // an object of that name may be of another kind now
    pack::Bind(behind.buffer(), SurfaceId(1), SurfaceId(1));
    pack::Renderbuffer(behind.buffer(), ClientName(7), 0, GL_RGBA8, 4, 4);
    session.expect_run(behind);
    const auto pixels = session.read(0, kWindow);
    EXPECT_EQ(pixels[0], 255) << "the window is as it was";
}

void pack_fan(wire::PackBuffer& b, float size) {
    pack::Begin(b, GL_TRIANGLE_FAN);
    for (int i = 0; i < 7; ++i) {
        const float a = static_cast<float>(i);
        pack::Color3f(b, 0.5f + 0.5f * std::cos(a), 0.3f, 0.1f * a);
        pack::Vertex3f(b, size * std::cos(a), size * std::sin(a), 0.1f * a - 0.5f);
    }
    pack::End(b);
}
void draw_fan(const Gl& gl, float size) {
    gl.Begin(GL_TRIANGLE_FAN);
    for (int i = 0; i < 7; ++i) {
        const float a = static_cast<float>(i);
        gl.Color3f(0.5f + 0.5f * std::cos(a), 0.3f, 0.1f * a);
        gl.Vertex3f(size * std::cos(a), size * std::sin(a), 0.1f * a - 0.5f);
    }
    gl.End();
}

TEST_F(ExecutorTest, GeometryIsTheSameAsPlainMesa) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    Batch batch;
    batch.set<el::clear_color>({0.2f, 0.1f, 0.4f, 0})
        .set<el::depth_test>(1)
        .set<el::fog_enabled>(1)
        .set<el::fog_density>(0.4f);
    batch.block(1, [](auto& b) {
        pack::Clear(b, kColorDepth);
        pack_fan(b, 0.8f);
    });
    session.expect_run(batch);
    expect_same(reference([](const Gl& gl) {
                    gl.ClearColor(0.2f, 0.1f, 0.4f, 0);
                    gl.Enable(GL_DEPTH_TEST);
                    gl.Enable(GL_FOG);
                    gl.Fogf(GL_FOG_DENSITY, 0.4f);
                    gl.Clear(kColorDepth);
                    draw_fan(gl, 0.8f);
                }),
                session.read(0, kWindow));
}

TEST_F(ExecutorTest, LightsAndPlanesAreTakenInEyeCoordinates) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    const glstate::Mat4 modelview = {0.8f, 0.1f, 0, 0, -0.1f, 0.7f, 0.2f, 0, 0, 0.3f, 0.9f, 0, 0.1f, -0.1f, 0.2f, 1};
    Batch batch;
    batch.set<el::modelview>(modelview).set<el::lighting_enabled>(1).set<el::light_enabled>(1);
    batch.set<el::light_position>({0.3f, 0.5f, 1, 1})
        .set<el::clip_plane_enabled>(1)
        .set<el::clip_plane>({1, 0.3f, 0, 0.4f});
    batch.set<el::normalize>(1).set<el::color_material_enabled>(1);
    const auto body = [](auto& b) {
        pack::Clear(b, kColorDepth);
        pack::Normal3f(b, 0.2f, 0.3f, 1);
        pack_fan(b, 0.9f);
    };
    batch.block(1, body);
    session.expect_run(batch);
    expect_same(reference([&](const Gl& gl) {
                    const std::array<float, 4> light = {0.3f, 0.5f, 1, 1};
                    const std::array<double, 4> plane = {1, static_cast<double>(0.3f), 0, static_cast<double>(0.4f)};
                    gl.Lightfv(GL_LIGHT0, GL_POSITION, light.data());
                    gl.ClipPlane(GL_CLIP_PLANE0, plane.data());
                    gl.LoadMatrixf(modelview.data());
                    for (const GLenum cap : {GL_LIGHTING, GL_LIGHT0, GL_CLIP_PLANE0, GL_NORMALIZE, GL_COLOR_MATERIAL})
                        gl.Enable(cap);
                    gl.Clear(kColorDepth);
                    gl.Normal3f(0.2f, 0.3f, 1);
                    draw_fan(gl, 0.9f);
                }),
                session.read(0, kWindow));
}

TEST_F(ExecutorTest, ImagesAtTheRasterPosition) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    std::vector<std::byte> image(20 * 10 * 3), bits(3 * 13);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::byte>(i * 11);
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = static_cast<std::byte>(i * 37 + 5);
    Batch batch;
    batch.set<el::raster_position>({31.5f, 20.25f, 0.3f, 1})
        .set<el::raster_color>({0.9f, 0.2f, 0.1f, 1})
        .set<el::pixel_zoom>({1.5f, 2});
    batch.set<el::color>({0.1f, 0.8f, 0.3f, 1});
    batch.block(1, [&](auto& b) {
        pack::Clear(b, kColorDepth);
        pack::DrawPixels(b, 20, 10, GL_RGB, GL_UNSIGNED_BYTE, image);
        for (int i = 0; i < 3; ++i) pack::Bitmap(b, 20, 13, 1, 2, 17.25f, 20, bits);
        pack::Begin(b, GL_LINES);  // the current colour is not the raster colour
        pack::Vertex2f(b, -0.9f, -0.9f);
        pack::Vertex2f(b, 0.9f, -0.7f);
        pack::End(b);
    });
    session.expect_run(batch);
    expect_same(reference([&](const Gl& gl) {
                    gl.Clear(kColorDepth);
                    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
                    gl.Color3f(0.9f, 0.2f, 0.1f);
                    gl.WindowPos3f(31.5f, 20.25f, 0.3f);
                    gl.PixelZoom(1.5f, 2);
                    gl.DrawPixels(20, 10, GL_RGB, GL_UNSIGNED_BYTE, image.data());
                    for (int i = 0; i < 3; ++i)
                        gl.Bitmap(20, 13, 1, 2, 17.25f, 20, reinterpret_cast<const GLubyte*>(bits.data()));
                    gl.Color3f(0.1f, 0.8f, 0.3f);
                    gl.Begin(GL_LINES);
                    gl.Vertex2f(-0.9f, -0.9f);
                    gl.Vertex2f(0.9f, -0.7f);
                    gl.End();
                }),
                session.read(0, kWindow));
    const auto& soft = session.session.context(ContextId(1)).state;
    EXPECT_EQ(el::raster_position::ref(soft), (glstate::Vec4{31.5f + 3 * 17.25f, 20.25f + 60, 0.3f, 1}));
}

TEST_F(ExecutorTest, TexturesAreRemapped) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    std::vector<std::byte> image(16 * 16 * 4);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::byte>(i * i >> 3);
    Batch batch;
    pack::TexImage(batch.buffer(), ClientName(77), GL_TEXTURE_2D, 0, GL_RGBA, 16, 16, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   image);
    pack::TexParameter(batch.buffer(), ClientName(77), GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR, 0, 0, 0);
    batch.set<el::texture_binding_2d>(77).set<el::texture_2d_enabled>(1);
    batch.block(1, [](auto& b) {
        pack::Clear(b, kColorDepth);
        pack::Begin(b, GL_TRIANGLES);
        for (const auto& v : {std::array{-0.9f, -0.8f}, std::array{0.8f, -0.5f}, std::array{0.1f, 0.9f}}) {
            pack::TexCoord2f(b, v[0] * 2, v[1] * 3);
            pack::Vertex2f(b, v[0], v[1]);
        }
        pack::End(b);
    });
    session.expect_run(batch);
    expect_same(reference([&](const Gl& gl) {
                    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 16, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
                    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
                    gl.Enable(GL_TEXTURE_2D);
                    gl.Clear(kColorDepth);
                    gl.Begin(GL_TRIANGLES);
                    for (const auto& v : {std::array{-0.9f, -0.8f}, std::array{0.8f, -0.5f}, std::array{0.1f, 0.9f}}) {
                        gl.TexCoord2f(v[0] * 2, v[1] * 3);
                        gl.Vertex2f(v[0], v[1]);
                    }
                    gl.End();
                }),
                session.read(0, kWindow));
}

TEST_F(ExecutorTest, ImagesAreCompressedAsTheDriverDoes) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    const auto objects = *node_.driver->gl().objects;
    Batch batch;
    const std::vector<std::byte> white(5 * 3 * 4, std::byte{255});  // ends within its second block
    pack::Compress(batch.buffer(), RequestId(7), GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 5, 3, GL_RGBA, GL_UNSIGNED_BYTE,
                   white);
    pack::Compress(batch.buffer(), RequestId(8), GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, 5, 3, GL_RGBA, GL_UNSIGNED_BYTE,
                   white);
    session.expect_run(batch);
    ASSERT_EQ(session.replies[RequestId(7)].size(), 2u * 8);
    ASSERT_EQ(session.replies[RequestId(8)].size(), 2u * 16);
    std::uint16_t color = 0;
    std::memcpy(&color, session.replies[RequestId(7)].data(), sizeof color);
    EXPECT_EQ(color, 0xffff);
    EXPECT_EQ(node_.driver->gl().objects->textures, objects.textures);

    Batch wrong;
    pack::Compress(wrong.buffer(), RequestId(9), GL_RGBA8, 5, 3, GL_RGBA, GL_UNSIGNED_BYTE, white);
    EXPECT_FALSE(session.run(wrong));
    Batch small;
    pack::Compress(small.buffer(), RequestId(9), GL_COMPRESSED_RGB_S3TC_DXT1_EXT, 5, 4, GL_RGBA, GL_UNSIGNED_BYTE,
                   white);
    EXPECT_FALSE(session.run(small));
}

TEST_F(ExecutorTest, BlockOnTwoTilesStartsEachFromTheSameAttributes) {
    node_.node->tiles = {{0, {0, 0, 80, kHeight}}, {1, {80, 0, 80, kHeight}}};
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    Batch batch;
    batch.set<el::color>({1, 0, 0, 1});
    batch.block(3, [](auto& b) {
        pack::Clear(b, kColorDepth);
        pack::Begin(b, GL_QUADS);  // the red that the block starts with, on both tiles
        for (const auto& v :
             {std::array{-1.f, -1.f}, std::array{1.f, -1.f}, std::array{1.f, 0.f}, std::array{-1.f, 0.f}})
            pack::Vertex2f(b, v[0], v[1]);
        pack::Color3f(b, 0, 0, 1);
        for (const auto& v : {std::array{-1.f, 0.f}, std::array{1.f, 0.f}, std::array{1.f, 1.f}, std::array{-1.f, 1.f}})
            pack::Vertex2f(b, v[0], v[1]);
        pack::End(b);
    });
    session.expect_run(batch);
    for (std::uint32_t slot : {0u, 1u}) {
        const auto low = session.read(slot, {static_cast<int>(slot) * 80 + 10, 10, 1, 1}),
                   high = session.read(slot, {static_cast<int>(slot) * 80 + 10, 100, 1, 1});
        EXPECT_EQ(low, (Pixels{255, 0, 0, 255})) << slot;
        EXPECT_EQ(high, (Pixels{0, 0, 255, 255})) << slot;
    }
    EXPECT_EQ(el::color::ref(session.session.context(ContextId(1)).state), (glstate::Vec4{0, 0, 1, 1}));
}

TEST_F(ExecutorTest, BlockWithoutALayerKeepsItsEffects) {
    TestSession session(*node_.node, SessionId(1));
    Batch batch;
    batch.block(4, [](auto& b) { pack::Color3f(b, 0.25f, 0.5f, 0.75f); });
    session.expect_run(batch);
    EXPECT_EQ(el::color::ref(session.session.context(ContextId(1)).state), (glstate::Vec4{0.25f, 0.5f, 0.75f, 1}));
}

TEST_F(ExecutorTest, TwoSessionsInTurnsDrawAsEachAlone) {
    const auto frame_of = [](int who, float size) {
        Batch batch;
        if (who == 0) batch.set<el::fog_enabled>(1).set<el::fog_density>(size).set<el::cull_face_enabled>(1);
        if (who == 1)
            batch.set<el::blend_enabled>(1)
                .set<el::blend_func>({GL_ONE, GL_ONE, GL_ONE, GL_ONE})
                .set<el::shade_model>(GL_FLAT);
        batch.block(1, [size](auto& b) {
            pack::Clear(b, kColorDepth);
            pack_fan(b, size);
        });
        return batch;
    };
    std::array<Pixels, 2> alone;
    for (int who = 0; who < 2; ++who) {
        TestSession session(*node_.node, SessionId(9));
        session.open_surface(kWidth, kHeight, kWindow);
        for (float size : {0.4f, 0.6f, 0.8f}) session.expect_run(frame_of(who, size));
        alone[static_cast<std::size_t>(who)] = session.read(0, kWindow);
    }
    TestSession first(*node_.node, SessionId(1)), second(*node_.node, SessionId(2));
    first.open_surface(kWidth, kHeight, kWindow);
    second.open_surface(kWidth, kHeight, kWindow);
    for (float size : {0.4f, 0.6f, 0.8f}) {
        first.expect_run(frame_of(0, size));
        second.expect_run(frame_of(1, size));
    }
    expect_same(alone[0], first.read(0, kWindow));
    expect_same(alone[1], second.read(0, kWindow));
}

// Whole pixels, so that the orientation of the reference's memory does not matter.
constexpr std::array<std::array<float, 4>, 3> kSquares = {
    {{0.9f, 0.3f, 0.1f, 0.25f}, {0.2f, 0.77f, 0.5f, 0.5f}, {0.13f, 0.41f, 0.99f, 0.75f}}};

// Mesa keeps a colour outside of glBegin to itself for a while; what it tracks may change meanwhile.
TEST_F(ExecutorTest, ColorMaterialSurvivesASwitch) {
    const glstate::Vec4 black{0, 0, 0, 1}, white{1, 1, 1, 1}, green{0, 1, 0, 1};
    TestSession session(*node_.node, SessionId(1)), other(*node_.node, SessionId(2));
    session.open_surface(kWidth, kHeight, kWindow);
    other.open_surface(kWidth, kHeight, kWindow);
    const auto clear = [](auto& b) { pack::Clear(b, kColorDepth); };
    Batch first;
    first.set<el::lighting_enabled>(1).set<el::light_enabled>(1).set<el::light_model_ambient>(black);
    first.set<el::light_ambient>(black).set<el::light_specular>(black).set<el::light_diffuse>(white);
    first.set<el::material_diffuse>(white).set<el::material_diffuse>(white, 1);
    first.set<el::color_material>({GL_FRONT_AND_BACK, GL_AMBIENT})
        .set<el::color_material_enabled>(1)
        .set<el::color>(green);
    first.block(1, clear);
    session.expect_run(first);
    Batch between;
    between.block(1, [&](auto& b) { pack_fan(b, 0.5f); });
    other.expect_run(between);
    Batch second;
    second.block(1, clear);
    second.set<el::color_material>({GL_FRONT_AND_BACK, GL_DIFFUSE});
    second.block(1, [](auto& b) {
        pack::Begin(b, GL_TRIANGLES);
        pack::Normal3f(b, 0, 0, 1);
        for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {3.0f, -1.0f}, {-1.0f, 3.0f}}) pack::Vertex2f(b, x, y);
        pack::End(b);
    });
    session.expect_run(second);
    EXPECT_EQ(session.read(0, {kWidth / 2, kHeight / 2, 1, 1}), (Pixels{0, 255, 0, 255}));
}

TEST_F(ExecutorTest, AccumulationBuffer) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow, ContextId(1), true);
    Batch batch;
    batch.set<el::clear_accum>({0.1f, 0, 0.2f, 0}).set<el::color_mask>({1, 0, 1, 1});
    batch.block(1, [](auto& b) { pack::Clear(b, kColorDepth | GL_ACCUM_BUFFER_BIT); });
    for (const auto& c : kSquares) {
        batch.block(1, [&](auto& b) {
            pack::Begin(b, GL_QUADS);
            pack::Color4f(b, c[0], c[1], c[2], c[3]);
            for (const auto& v :
                 {std::array{-1.f, -1.f}, std::array{c[3], -1.f}, std::array{c[3], c[3]}, std::array{-1.f, c[3]}})
                pack::Vertex2f(b, v[0], v[1]);
            pack::End(b);
            pack::Accum(b, GL_ACCUM, 0.31f);
        });
    }
    batch.block(1, [](auto& b) {
        pack::Accum(b, GL_ADD, 0.05f);
        pack::Accum(b, GL_MULT, 0.9f);
        pack::Accum(b, GL_RETURN, 1.05f);
    });
    session.expect_run(batch);
    const auto drawn = session.read(0, kWindow);
    const auto window = AccumReference::open(kWidth, kHeight);
    if (!window) GTEST_SKIP() << "off-screen Mesa is not installed";
    const Gl& gl = window->gl();
    gl.ClearAccum(0.1f, 0, 0.2f, 0);
    gl.ColorMask(1, 0, 1, 1);
    gl.Clear(kColorDepth | GL_ACCUM_BUFFER_BIT);
    for (const auto& c : kSquares) {
        gl.Color4f(c[0], c[1], c[2], c[3]);
        gl.Rectf(-1, -1, c[3], c[3]);
        gl.Accum(GL_ACCUM, 0.31f);
    }
    gl.Accum(GL_ADD, 0.05f);
    gl.Accum(GL_MULT, 0.9f);
    gl.Accum(GL_RETURN, 1.05f);
    const auto expected = window->read();
    node_.make_current();
    expect_same(expected, drawn);
}

TEST_F(ExecutorTest, FeedbackAnswersWhatWasDrawn) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    Batch batch;
    pack::RenderMode(batch.buffer(), RequestId(1), GL_FEEDBACK, GL_2D, 100);
    batch.block(std::uint64_t{1} << wire::kOffscreenSlot, [](auto& b) {
        pack::Begin(b, GL_POINTS);
        pack::Vertex2f(b, 0, 0);
        pack::Vertex2f(b, 0.5f, -0.5f);
        pack::End(b);
    });
    pack::RenderMode(batch.buffer(), RequestId(2), GL_RENDER, 0, 0);
    session.expect_run(batch);
    ASSERT_EQ(session.replies[RequestId(1)].size(), 4u);
    ASSERT_EQ(session.replies[RequestId(2)].size(), 4u + 6 * 4);
    std::array<float, 6> values{};
    std::memcpy(values.data(), session.replies[RequestId(2)].data() + 4, sizeof values);
    EXPECT_EQ(values, (std::array<float, 6>{GL_POINT_TOKEN, 80, 60, GL_POINT_TOKEN, 120, 30}));
}

/// What a program may do in selection mode.
struct Pick {
    enum class What { init, load, push, pop, triangle, outside } what;
    GLuint value = 0;  // a name, or which triangle
};

std::vector<Pick> random_picks(std::uint32_t seed, int count) {
    std::mt19937 random(seed);
    std::vector<Pick> picks;
    for (int i = 0; i < count; ++i) {
        const auto kind =
            static_cast<Pick::What>(std::min<std::uint32_t>(static_cast<std::uint32_t>(random()) % 12, 5));
        picks.push_back({random() % 3 == 0   ? kind
                         : random() % 4 == 0 ? Pick::What::outside
                                             : Pick::What::triangle,
                         static_cast<GLuint>(random() % 4)});
        if (random() % 3 == 0) picks.push_back({kind, static_cast<GLuint>(random() % 4)});
    }
    return picks;
}

float depth_of(GLuint value) { return 0.2f * static_cast<float>(value) - 0.5f; }

/// Pushes and pops too many are among them: nothing happens then.
void pick(const Gl& gl, const Pick& p) {
    switch (p.what) {
        case Pick::What::init: return gl.InitNames();
        case Pick::What::load: return gl.LoadName(p.value);
        case Pick::What::push: return gl.PushName(p.value);
        case Pick::What::pop: return gl.PopName();
        default: break;
    }
    const float z = depth_of(p.value), at = p.what == Pick::What::outside ? 5.0f : 0.0f;
    gl.Begin(GL_TRIANGLES);
    gl.Vertex3f(at - 0.5f, -0.5f, z);
    gl.Vertex3f(at + 0.5f, -0.5f, z + 0.1f);
    gl.Vertex3f(at, 0.5f, z);
    gl.End();
}
void pack_pick(wire::PackBuffer& b, const Pick& p) {
    switch (p.what) {
        case Pick::What::init: return pack::InitNames(b);
        case Pick::What::load: return pack::LoadName(b, p.value);
        case Pick::What::push: return pack::PushName(b, p.value);
        case Pick::What::pop: return pack::PopName(b);
        default: break;
    }
    const float z = depth_of(p.value), at = p.what == Pick::What::outside ? 5.0f : 0.0f;
    pack::Begin(b, GL_TRIANGLES);
    pack::Vertex3f(b, at - 0.5f, -0.5f, z);
    pack::Vertex3f(b, at + 0.5f, -0.5f, z + 0.1f);
    pack::Vertex3f(b, at, 0.5f, z);
    pack::End(b);
}

// Selection is a mode of the driver's one context: it is left between two turns, and the hits of all parts are put
// together. The program must see one selection.
TEST_F(ExecutorTest, SelectionGoesOnBetweenOthersTurns) {
    for (const std::uint32_t entries : {4000u, 13u, 0u}) {
        int too_many = 0;
        for (std::uint32_t seed = 1; seed <= 12; ++seed) {
            const auto picks = random_picks(seed, 90);
            std::vector<GLuint> expected(std::max(entries, 1u));
            GLint hits = 0;
            if (entries != 0)
                reference([&](const Gl& gl) {
                    gl.SelectBuffer(static_cast<GLsizei>(entries), expected.data());
                    gl.RenderMode(GL_SELECT);
                    for (const Pick& p : picks) pick(gl, p);
                    hits = gl.RenderMode(GL_RENDER);
                });
            TestSession session(*node_.node, SessionId(1)), other(*node_.node, SessionId(2));
            session.open_surface(kWidth, kHeight, kWindow);
            other.open_surface(kWidth, kHeight, kWindow);
            Batch begin, end, clear;
            pack::RenderMode(begin.buffer(), RequestId(1), GL_SELECT, 0, entries);
            pack::RenderMode(end.buffer(), RequestId(2), GL_RENDER, 0, 0);
            clear.block(1, [](auto& b) { pack::Clear(b, kColorDepth); });
            session.expect_run(begin);
            for (const Pick& p : picks) {
                Batch batch;
                batch.block(std::uint64_t{1} << wire::kOffscreenSlot, [&](auto& b) { pack_pick(b, p); });
                session.expect_run(batch);
                GLint mode = 0;
                node_.driver->gl().GetIntegerv(GL_RENDER_MODE, &mode);
                ASSERT_EQ(mode, GL_RENDER) << "others can draw";
                other.expect_run(clear);
            }
            session.expect_run(end);
            GLint found = 0;
            const auto& answer = session.replies[RequestId(2)];
            ASSERT_GE(answer.size(), sizeof found);
            std::memcpy(&found, answer.data(), sizeof found);
            if (entries == 0) {
                EXPECT_EQ(found, -1);
                EXPECT_EQ(answer.size(), sizeof found);
                continue;
            }
            EXPECT_EQ(found, hits) << "seed " << seed << ", " << entries << " entries";
            too_many += found < 0 ? 1 : 0;
            std::vector<GLuint> content((answer.size() - sizeof found) / sizeof(GLuint));
            std::memcpy(content.data(), answer.data() + sizeof found, content.size() * sizeof(GLuint));
            ASSERT_LE(content.size(), expected.size());
            EXPECT_EQ(content, std::vector<GLuint>(expected.begin(),
                                                   expected.begin() + static_cast<std::ptrdiff_t>(content.size())))
                << "seed " << seed;
        }
        EXPECT_EQ(too_many > 0, entries == 13);
    }
}

TEST_F(ExecutorTest, MoreNamesThanTheDriverIsGivenAtOnce) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    constexpr GLuint kMany = 5000;
    Batch batch;
    pack::RenderMode(batch.buffer(), RequestId(1), GL_SELECT, 0, 4 * kMany);
    batch.block(std::uint64_t{1} << wire::kOffscreenSlot, [](auto& b) {
        pack::PushName(b, 0);
        for (GLuint i = 0; i < kMany; ++i) {
            pack::LoadName(b, i);
            pack_pick(b, {Pick::What::triangle, 1});
        }
    });
    pack::RenderMode(batch.buffer(), RequestId(2), GL_RENDER, 0, 0);
    session.expect_run(batch);
    std::vector<GLuint> answer(session.replies[RequestId(2)].size() / sizeof(GLuint));
    std::memcpy(answer.data(), session.replies[RequestId(2)].data(), answer.size() * sizeof(GLuint));
    ASSERT_EQ(answer.size(), 1 + std::size_t{4} * kMany);
    EXPECT_EQ(answer[0], kMany);
    for (GLuint i = 0; i < kMany; ++i) ASSERT_EQ(answer[1 + std::size_t{4} * i + 3], i);
}

TEST_F(ExecutorTest, WindowsHaveNoMorePixelsThanTheSessionMayHave) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    const auto open = [&](std::uint32_t number, std::uint32_t width) {  // off the wall: all of it is one layer
        Batch batch;
        pack::SurfaceCreate(batch.buffer(), SurfaceId(number), 1, 0, 24, 8, 0, 0, 1, 0);
        pack::SurfacePlace(batch.buffer(), SurfaceId(number), 1, width, 10, 0, 0, 0, 0, wire::kAlsoWholeWindow);
        pack::SwapOffscreen(batch.buffer(), SurfaceId(number));
        pack::Bind(batch.buffer(), SurfaceId(number), SurfaceId(number));
        batch.block(std::uint64_t{1} << wire::kOffscreenSlot, [](auto& b) { pack::Clear(b, kColorDepth); });
        session.expect_run(batch);
        return session.session.surface(SurfaceId(number))->layer(wire::kOffscreenSlot) != nullptr;
    };
    session.session.set_most_pixels(kWidth * kHeight + 1000);
    EXPECT_TRUE(open(2, 60));
    EXPECT_FALSE(open(3, 60));
    session.session.set_most_pixels(kWidth * kHeight + 1200);
    EXPECT_TRUE(open(4, 60));
    session.session.set_most_pixels(10);
    EXPECT_NE(session.session.surface(SurfaceId(2))->layer(wire::kOffscreenSlot), nullptr) << "what it has, it keeps";
    EXPECT_FALSE(open(5, 1));
}

/// Mesa 22.3 keeps vertices that are outside of Begin and End, and then leaves out what the next one draws.
TEST_F(ExecutorTest, StrayVerticesKeepNobodyFromDrawing) {
    const auto vertices = [](auto& b, int count) {
        for (int i = 0; i < count; ++i) pack::Vertex2f(b, 1, -1);
    };
    const std::vector<std::function<void(wire::PackBuffer&)>> strays = {
        [&](auto& b) {  // behind an End
            pack::Begin(b, GL_QUADS);
            pack::End(b);
            vertices(b, 1);
            pack::Color3f(b, 1, 0, 0);
        },
        [&](auto& b) {  // behind a Begin that the driver refuses: there is no tessellation
            pack::Begin(b, GL_PATCHES);
            for (int i = 0; i < 4; ++i) pack::TexCoord3f(b, 1, 1, 1), vertices(b, 1);
            pack::End(b);
            pack::Begin(b, GL_QUADS);
            pack::TexCoord3f(b, 1, 1, 1);
            pack::End(b);
        },
        [&](auto& b) {  // behind one that is none
            pack::Begin(b, 0x27000007);
            vertices(b, 4);
            pack::End(b);
            pack::Begin(b, GL_QUADS);
            pack::TexCoord3f(b, 1, 1, 1);
            pack::End(b);
        }};
    for (const auto& stray : strays) {
        Batch first, second;
        first.block(1, stray);
        {
            TestSession session(*node_.node, SessionId(1));
            session.open_surface(kWidth, kHeight, kWindow);
            session.expect_run(first);
            TestSession again(*node_.node, SessionId(3));
            again.open_surface(kWidth, kHeight, kWindow);
            again.expect_run(first);
        }
        TestSession other(*node_.node, SessionId(2));
        other.open_surface(kWidth, kHeight, kWindow);
        second.block(1, [](auto& b) {
            pack::Clear(b, kColorDepth);
            pack::Color4ub(b, 0xff00ff00);
            pack::Begin(b, GL_QUADS);
            for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}})
                pack::Vertex2f(b, x, y);
            pack::End(b);
        });
        other.expect_run(second);
        EXPECT_EQ(other.read(0, {5, 5, 1, 1})[1], 255);
    }
}

TEST_F(ExecutorTest, FeedbackGoesOnBetweenOthersTurns) {
    for (const std::uint32_t entries : {12u, 9u, 2u, 0u}) {
        TestSession session(*node_.node, SessionId(1)), other(*node_.node, SessionId(2));
        session.open_surface(kWidth, kHeight, kWindow);
        other.open_surface(kWidth, kHeight, kWindow);
        Batch begin, point, clear, end;
        pack::RenderMode(begin.buffer(), RequestId(1), GL_FEEDBACK, GL_2D, entries);
        point.block(std::uint64_t{1} << wire::kOffscreenSlot, [](auto& b) {
            pack::Begin(b, GL_POINTS);
            pack::Vertex2f(b, 0, 0);
            pack::End(b);
        });
        clear.block(1, [](auto& b) { pack::Clear(b, kColorDepth); });
        pack::RenderMode(end.buffer(), RequestId(2), GL_RENDER, 0, 0);
        session.expect_run(begin);
        for (int i = 0; i < 4; ++i) {
            session.expect_run(point);
            other.expect_run(clear);
        }
        session.expect_run(end);
        std::int32_t result = 0;
        const auto& answer = session.replies[RequestId(2)];
        std::memcpy(&result, answer.data(), sizeof result);
        EXPECT_EQ(result, entries == 12 ? 12 : -1);
        ASSERT_EQ(answer.size(), sizeof result + entries * sizeof(float));
        std::vector<float> values(entries);
        if (!values.empty()) std::memcpy(values.data(), answer.data() + sizeof result, entries * sizeof(float));
        const std::array<float, 3> token = {GL_POINT_TOKEN, kWidth / 2, kHeight / 2};
        for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], token[i % 3]) << entries << ' ' << i;
    }
}

// ---- images that the driver refuses ----

class RefusedImageTest : public ExecutorTest {
protected:
    static constexpr int kSize = 256;
    static std::vector<std::byte> blocks(int size) {
        std::vector<std::byte> bytes(static_cast<std::size_t>(size / 4) * static_cast<std::size_t>(size / 4) * 16);
        for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 7 >> 3);
        return bytes;
    }
    /// A texture with a compressed image, and then `refused`; the blocks of a copy that the driver makes of it.
    template <class Refused>
    std::vector<std::byte> copied_after(Refused&& refused) {
        TestSession session(*node_.node, SessionId(1));
        session.open_surface(kWidth, kHeight, kWindow);
        Batch batch;
        pack::TexCompressed(batch.buffer(), ClientName(1), GL_TEXTURE_2D, 0, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, kSize,
                            kSize, 1, blocks(kSize));
        session.expect_run(batch);
        const auto bytes_before = session.session.objects.bytes();
        EXPECT_EQ(bytes_before, kLeastObjectBytes + blocks(kSize).size());
        Batch bad;
        refused(bad.buffer());
        session.expect_run(bad);
        EXPECT_GT(session.session.work.gl_errors, 0u) << "the driver has refused it";
        EXPECT_EQ(session.session.objects.bytes(), bytes_before);
        const Texture* texture = session.session.objects.find<Texture>(ClientName(1));
        const auto shared = texture->shared();  // held by another one, so that a change needs a copy
        Batch change;
        pack::TexParameter(change.buffer(), ClientName(1), GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST, 0, 0, 0);
        session.expect_run(change);
        EXPECT_NE(texture->shared(), shared);
        std::vector<std::byte> copied(blocks(kSize).size());
        node_.driver->gl().GetCompressedTextureImage(texture->content().name(), 0, static_cast<GLsizei>(copied.size()),
                                                     copied.data());
        return copied;
    }
};

TEST_F(RefusedImageTest, OfNoFormat) {
    EXPECT_EQ(copied_after(
                  [](auto& b) { pack::TexImage(b, ClientName(1), GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 1, 0, 0, 0, {}); }),
              blocks(kSize));
}

TEST_F(RefusedImageTest, LargerThanTheDriverAllows) {
    EXPECT_EQ(copied_after([](auto& b) {
                  constexpr int kTooWide = 16384 + 2;
                  const std::vector<std::byte> row(static_cast<std::size_t>(kTooWide + 3) / 4 * 16);
                  pack::TexCompressed(b, ClientName(1), GL_TEXTURE_2D, 0, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, kTooWide, 1,
                                      1, row);
              }),
              blocks(kSize));
}

TEST_F(RefusedImageTest, OfAFormatThatDoesNotGoWithTheImage) {
    EXPECT_EQ(copied_after([](auto& b) {
                  pack::TexImage(b, ClientName(1), GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 1, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                                 {});
              }),
              blocks(kSize));
}

/// Fills the layer of the whole window, at a place mostly off the tiles.
void draw_off_the_wall(TestSession& session, const glstate::Vec4& color) {
    Batch batch;
    batch.set<el::clear_color>(color);
    batch.block(std::uint64_t{1} << wire::kOffscreenSlot, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
    session.expect_run(batch);
}

void place(TestSession& session, std::int32_t x, std::uint32_t layers) {
    Batch batch;
    pack::SurfacePlace(batch.buffer(), SurfaceId(1), 2, kWidth, kHeight, x, 0, kWidth, kHeight, layers);
    session.expect_run(batch);
}

TEST_F(ExecutorTest, TheLayerOfTheWholeWindowStaysWhenTheWindowMovesOffTheWall) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    place(session, -kWidth / 2, wire::kAlsoWholeWindow);
    draw_off_the_wall(session, {1, 0, 0, 1});
    const auto drawn = session.read(wire::kOffscreenSlot, {0, 0, 1, 1});
    place(session, -10 * kWidth, wire::kAlsoWholeWindow);
    EXPECT_EQ(session.read(wire::kOffscreenSlot, {0, 0, 1, 1}), drawn);
    EXPECT_EQ(drawn[0], 255);
    place(session, 0, wire::kTilesOnly);
    EXPECT_EQ(session.read(wire::kOffscreenSlot, {0, 0, 1, 1})[0], 0) << "on the wall it is not needed";
    Batch wrong;
    pack::SurfacePlace(wrong.buffer(), SurfaceId(1), 3, kWidth, kHeight, 0, 0, kWidth, kHeight,
                       wire::kShownWholeWindow + 1);
    EXPECT_FALSE(session.run(wrong));
}

TEST_F(ExecutorTest, AFrameOffTheWallGoesToTheFrontBufferAlone) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    place(session, -kWidth / 2, wire::kAlsoWholeWindow);
    draw_off_the_wall(session, {1, 0, 0, 1});
    Batch swap;
    pack::SwapOffscreen(swap.buffer(), SurfaceId(1));
    session.expect_run(swap);
    EXPECT_TRUE(session.frames.empty()) << "nobody waits for it";
    EXPECT_FALSE(session.session.surface(SurfaceId(1))->waiting_frame());
    draw_off_the_wall(session, {0, 1, 0, 1});
    session.expect_run(Batch().set<el::read_buffer>(GL_FRONT));
    EXPECT_EQ(session.read(wire::kOffscreenSlot, {0, 0, 1, 1})[0], 255);
    session.expect_run(Batch().set<el::read_buffer>(GL_BACK));
    EXPECT_EQ(session.read(wire::kOffscreenSlot, {0, 0, 1, 1})[0], 0);
}

TEST_F(ExecutorTest, SwapKeepsTheFrameUntilItIsPresented) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    Batch batch;
    pack::Swap(batch.buffer(), SurfaceId(1), 5);
    session.expect_run(batch);
    EXPECT_EQ(session.frames, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{1, 5}}));
    EXPECT_TRUE(session.session.surface(SurfaceId(1))->waiting_frame());
    session.executor.present(SurfaceId(1), 5);
    EXPECT_FALSE(session.session.surface(SurfaceId(1))->waiting_frame());
}

TEST_F(ExecutorTest, TheFrontBufferIsTheFrameThatEndedLast) {
    TestSession session(*node_.node, SessionId(1));
    session.open_surface(kWidth, kHeight, kWindow);
    const auto frame = [&](const glstate::Vec4& color, std::uint32_t number) {
        Batch batch;
        batch.set<el::clear_color>(color).set<el::read_buffer>(GL_FRONT);
        batch.block(1, [](auto& b) { pack::Clear(b, GL_COLOR_BUFFER_BIT); });
        pack::Swap(batch.buffer(), SurfaceId(1), number);
        session.expect_run(batch);
        return session.read(0, {0, 0, 1, 1});
    };
    EXPECT_EQ(frame({1, 0, 0, 1}, 1), (Pixels{255, 0, 0, 255}));  // shown or not
    session.executor.present(SurfaceId(1), 1);
    EXPECT_EQ(session.read(0, {0, 0, 1, 1}), (Pixels{255, 0, 0, 255}));
    EXPECT_EQ(frame({0, 1, 0, 1}, 2), (Pixels{0, 255, 0, 255}));
    session.executor.present(SurfaceId(1), 2);
    EXPECT_EQ(frame({0, 0, 1, 1}, 3), (Pixels{0, 0, 255, 255}));
}

TEST_F(ExecutorTest, WorkIsCountedByWhatItIsFor) {
    TestSession session(*node_.node, SessionId(1)), other(*node_.node, SessionId(2));
    for (TestSession* each : {&session, &other}) each->open_surface(kWidth, kHeight, kWindow);
    const Work before = session.session.work;
    Batch batch;
    const auto& buffer = batch.buffer();
    batch.set<el::fog_density>(0.5f);
    const std::size_t state = buffer.bytes();
    batch.block(1, [](auto& b) { pack::Clear(b, kColorDepth); });
    const std::size_t geometry = buffer.bytes() - state;
    pack::TexImage(batch.buffer(), ClientName(1), GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   std::vector<std::byte>(4));
    pack::Swap(batch.buffer(), SurfaceId(1), 1);
    for (TestSession* each : {&session, &other, &session}) each->expect_run(batch);

    const Work& work = session.session.work;
    EXPECT_EQ(work.state_bytes - before.state_bytes, 2 * state);
    EXPECT_EQ(work.geometry_bytes - before.geometry_bytes, 2 * geometry);
    EXPECT_EQ(work.object_bytes - before.object_bytes, 2 * (buffer.bytes() - state - geometry));
    EXPECT_EQ(work.commands - before.commands, 2 * buffer.commands());
    EXPECT_EQ(work.frames, 2u);
    EXPECT_EQ(work.context_switches, 2u);
    EXPECT_EQ(other.session.work.context_switches, 1u);
    EXPECT_GT(work.render.count(), 0);
}

TEST_F(ExecutorTest, ObjectsOfAnEndedSessionAreGivenBack) {
    const DriverObjects before = *node_.driver->gl().objects;
    {
        TestSession session(*node_.node, SessionId(1));
        session.open_surface(kWidth, kHeight, kWindow);
        Batch batch;
        pack::TexImage(batch.buffer(), ClientName(1), GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                       std::vector<std::byte>(4));
        session.expect_run(batch);
        EXPECT_GT(node_.driver->gl().objects->textures, before.textures + 1) << "the layer's and the program's";
        EXPECT_GT(node_.driver->gl().objects->framebuffers, before.framebuffers);
    }
    EXPECT_EQ(*node_.driver->gl().objects, before);
}

TEST_F(ExecutorTest, BadStreamsAreRefusedWithAReason) {
    const auto reason = [this](auto&& fill) {
        TestSession session(*node_.node, SessionId(1));
        session.open_surface(kWidth, kHeight, kWindow);
        Batch batch;
        fill(batch);
        const auto done = session.run(batch);
        return done ? std::string("accepted") : done.error().message;
    };
    EXPECT_THAT(reason([](Batch& b) { b.block(1, [](auto& p) { pack::Begin(p, GL_LINES); }); }),
                ::testing::HasSubstr("Begin"));
    EXPECT_THAT(reason([](Batch& b) { b.block(1, [](auto& p) { pack::End(p); }); }), ::testing::HasSubstr("End"));
    EXPECT_THAT(reason([](Batch& b) { pack::Clear(b.buffer(), 1); }), ::testing::HasSubstr("Clear"));
    for (const std::uint32_t unit : {8u, 47u, 95u, ~0u})
        EXPECT_THAT(reason([&](Batch& b) { b.block(1, [&](auto& p) { pack::MultiTexCoord4f(p, unit, 0, 0, 0, 1); }); }),
                    ::testing::HasSubstr("no such texture coordinates"));
    EXPECT_THAT(reason([](Batch& b) {
                    b.block(1, [](auto& p) { pack::DrawPixels(p, 100, 100, GL_RGBA, GL_UNSIGNED_BYTE, {}); });
                }),
                ::testing::HasSubstr("DrawPixels"));
    EXPECT_THAT(reason([](Batch& b) { b.block(1, [](auto& p) { pack::RunCall(p, ClientName(3)); }); }),
                ::testing::HasSubstr("there is no run 3"));
    EXPECT_THAT(reason([](Batch& b) { pack::Swap(b.buffer(), SurfaceId(8), 1); }), ::testing::HasSubstr("Swap"));
    EXPECT_THAT(reason([](Batch& b) {
                    pack::TexImage(b.buffer(), ClientName(1), GL_TEXTURE_2D, 0, GL_RGBA, 1 << 30, 4, 1, 0, GL_RGBA,
                                   GL_FLOAT, {});
                }),
                ::testing::HasSubstr("TexImage"));
    // Another session goes on.
    TestSession session(*node_.node, SessionId(2));
    session.open_surface(kWidth, kHeight, kWindow);
    Batch batch;
    batch.block(1, [](auto& b) { pack::Clear(b, kColorDepth); });
    session.expect_run(batch);
}

TEST_F(ExecutorTest, EveryProperPrefixIsRefused) {
    Batch batch;
    batch.set<el::fog_density>(0.5f);
    batch.block(1, [](auto& b) { pack_fan(b, 0.5f); });
    pack::PixelMap(batch.buffer(), GL_PIXEL_MAP_R_TO_R, std::vector<std::byte>(8));
    const auto payload = batch.payload();
    for (std::size_t size = 0; size < payload.size(); ++size) {
        TestSession session(*node_.node, SessionId(1));
        EXPECT_FALSE(session.executor.run_batch(std::span(payload).first(size))) << size;
    }
}

}  // namespace
}  // namespace wall::tileserver::test
