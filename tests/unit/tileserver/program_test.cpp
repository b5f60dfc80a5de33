// SPDX-License-Identifier: MIT
// Programs in the driver: what is reported of them, locations by the client's numbers, and gl_FragCoord in layers.
#include "tileserver/objects/program.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "tests/unit/tileserver/reference_window.h"
#include "tileserver/gpu/backend.h"
#include "tileserver/objects/object_table.h"
#include "tileserver/objects/program_build.h"
#include "tileserver/objects/shader_patch.h"

namespace wall::tileserver {
namespace {

using namespace std::string_literals;

// ---- the source ----

std::string patched(const std::string& source) { return patch_fragment_shader(source).source; }

TEST(ShaderPatch, LeavesOthersAlone) {
    const std::string source =
        "// gl_FragCoord\nvoid main() { /* gl_FragCoord */ float my_gl_FragCoord = 1.0; gl_FragColor = "
        "vec4(my_gl_FragCoord); }\n";
    EXPECT_EQ(patched(source), source);
    EXPECT_FALSE(patch_fragment_shader(source).reads_window);
}

TEST(ShaderPatch, DeclaresBehindVersionAndExtensions) {
    const std::string source =
        "#version 120\n#ifdef GL_ARB_x\n#extension GL_ARB_x : enable\n#endif\n#ifdef GL_ES\nprecision mediump "
        "float;\n#endif\n"
        "void main() { gl_FragColor = gl_FragCoord; }";
    const std::string out = patched(source);
    const auto declared = out.find("uniform vec4 wallgl_Window;");
    EXPECT_GT(declared, out.find("#endif"));
    EXPECT_LT(declared, out.find("#ifdef GL_ES"));
    EXPECT_NE(out.find("gl_FragColor = wallgl_FragCoord;"), out.npos);
}

TEST(ShaderPatch, KeepsRedeclarations) {
    const std::string out = patched(
        "#version 150\nlayout(origin_upper_left) in vec4 gl_FragCoord;\nout vec4 c;\nvoid main() { c = gl_FragCoord; "
        "}\n");
    EXPECT_NE(out.find("in vec4 gl_FragCoord;"), out.npos);
    EXPECT_NE(out.find("c = wallgl_FragCoord;"), out.npos);
    EXPECT_TRUE(
        patch_fragment_shader("layout(origin_upper_left) in vec4 gl_FragCoord; void main() { vec4 a = gl_FragCoord; }")
            .upper_left);
}

TEST(ShaderPatch, KnowsWhereThePixelsMiddlesAre) {
    const PatchedShader patched_shader = patch_fragment_shader(
        "#version 150\nlayout(pixel_center_integer) in vec4 gl_FragCoord;\nout vec4 c;\nvoid main() { c = "
        "gl_FragCoord; }\n");
    EXPECT_TRUE(patched_shader.whole_centers);
    EXPECT_FALSE(patched_shader.upper_left);
}

TEST(ShaderPatch, ReplacesInExpressions) {
    EXPECT_NE(patched("void main() { gl_FragColor = vec4(gl_FragCoord.xy, vec2(1e2 * gl_FragCoord)); }")
                  .find("vec4(wallgl_FragCoord.xy, vec2(1e2 * wallgl_FragCoord))"),
              std::string::npos);
}

TEST(ShaderPatch, ReplacesInMacrosAndGoesOverContinuedLines) {
    const std::string out = patched("#define HERE \\\n gl_FragCoord\nvoid main() { gl_FragColor = HERE; }\n");
    EXPECT_NE(out.find("#define HERE \\\n wallgl_FragCoord\n"), out.npos);
}

TEST(ShaderPatch, TakesAnyBytes) {
    for (const std::string& source :
         {""s, "#"s, "/*"s, "\\"s, "#version"s, "gl_FragCoord"s, "#if\ngl_FragCoord"s, "1e"s, "\n#\n#endif\n"s})
        patched(source);
}

// ---- the driver ----

class ProgramsTest : public ::testing::Test {
protected:
    void SetUp() override {
        auto opened = open_backend("egl");
        if (!opened) GTEST_SKIP() << opened.error().message;
        backend_ = std::move(*opened);
        ASSERT_TRUE(backend_->make_current());
        Gl gl;
        gl.load([&](const char* name) { return backend_->get_proc_address(name); });
        driver_ = std::make_unique<Driver>(gl);
        objects_ = std::make_unique<ObjectTable>();
    }
    void TearDown() override {
        objects_.reset();
        driver_.reset();
        backend_.reset();
    }
    glapi::ProgramReflection link(std::uint32_t name, const glapi::ProgramDefinition& definition) {
        auto reply = program(name).link(encode(definition), true);
        EXPECT_TRUE(reply);
        auto reflection = reply ? glapi::decode_reflection(*reply) : std::nullopt;
        EXPECT_TRUE(reflection);
        return reflection.value_or(glapi::ProgramReflection{});
    }
    Program& program(std::uint32_t name) { return **objects_->make<Program>(ClientName(name), *driver_); }
    Result<void> set(std::uint32_t name, std::uint32_t location, GLenum type, std::uint32_t count,
                     const std::vector<float>& values) {
        return program(name).set_uniform(location, type, count, std::as_bytes(std::span(values)));
    }
    test::Pixels draw(std::uint32_t name, const LayerGeometry& geometry) {
        PixelBudget budget;
        Layer layer(driver_->gl(), driver_->flip_y(), geometry, {}, budget);
        layer.bind(GL_BACK, GL_BACK);
        const Gl& gl = driver_->gl();
        gl.Viewport(0, 0, layer.width(), layer.height());
        program(name).use(geometry);
        gl.Rectf(-1, -1, 1, 1);
        driver_->use_program(0);
        return test::read_pixels(gl, layer.width(), layer.height());
    }

    std::unique_ptr<GlBackend> backend_;
    std::unique_ptr<Driver> driver_;
    std::unique_ptr<ObjectTable> objects_;
};

constexpr const char* kVertex =
    "attribute vec3 place; void main() { gl_Position = gl_Vertex + vec4(place * 0.0, 0.0); }";

glapi::ProgramDefinition with_fragment(const std::string& fragment) {
    return {{{GL_VERTEX_SHADER, true, kVertex}, {GL_FRAGMENT_SHADER, true, fragment}}, {{3, "place"}}, {}};
}

TEST_F(ProgramsTest, TellsHowCompilingWent) {
    auto good = glapi::decode_compile_result(
        *compile_shader(driver_->gl(), GL_VERTEX_SHADER, std::as_bytes(std::span(std::string_view(kVertex)))));
    EXPECT_TRUE(good->compiled);
    auto bad = glapi::decode_compile_result(
        *compile_shader(driver_->gl(), GL_FRAGMENT_SHADER, std::as_bytes(std::span(std::string_view("nonsense")))));
    EXPECT_FALSE(bad->compiled);
    EXPECT_FALSE(bad->log.empty());
    EXPECT_FALSE(compile_shader(driver_->gl(), GL_FLOAT, {}));
}

TEST_F(ProgramsTest, ReflectsUniformsAndAttributes) {
    const auto r = link(
        1, with_fragment(
               "#version 120\nuniform float a = 2.5; uniform vec3 many[3]; uniform sampler2D image; uniform bool on;\n"
               "void main() { gl_FragColor = vec4(many[0] + many[2] * a, on ? 1.0 : 0.0) * texture2D(image, "
               "gl_FragCoord.xy) *"
               " gl_LightSource[0].diffuse; }"));
    ASSERT_TRUE(r.linked) << r.log;
    const auto find = [&](const std::string& name) {
        for (const auto& u : r.uniforms)
            if (u.name == name) return u;
        return glapi::ActiveUniform{};
    };
    EXPECT_EQ(find("many").size, 3u);
    EXPECT_TRUE(find("many").array);
    EXPECT_EQ(find("many").initial.size(), 9u);
    EXPECT_EQ(find("image").type, GLenum{GL_SAMPLER_2D});
    float initial = 0;
    std::memcpy(&initial, find("a").initial.data(), sizeof initial);
    EXPECT_EQ(initial, 2.5f);
    EXPECT_EQ(find(kWindowUniform).type, GLenum{0}) << "ours must not show";
    ASSERT_FALSE(r.attributes.empty());
    for (const auto& attribute : r.attributes) EXPECT_TRUE(attribute.name != "place" || attribute.location == 3);
}

TEST_F(ProgramsTest, ReflectsWhatCameWithOpenGL3) {
    glapi::ProgramDefinition definition{
        {{GL_VERTEX_SHADER, true,
          "#version 330\nlayout(location = 5) in ivec3 place; out vec3 speed; uniform Turn { mat4 m; vec2 a[3]; } "
          "turn;\n"
          "void main() { speed = vec3(gl_VertexID); gl_Position = turn.m * vec4(place + turn.a[2].xyx, 1); }"},
         {GL_FRAGMENT_SHADER, true,
          "#version 330\nlayout(std140, row_major) uniform Light { vec4 color; mat3 m; } ;\n"
          "uniform uvec2 mask = uvec2(4294967295u, 3u); uniform usampler2D image; uniform samplerCubeShadow depths;\n"
          "in vec3 speed; out vec4 tint; out uvec4 more[2];\n"
          "void main() { tint = color * texture(depths, vec4(speed, 1)) * m[0][0]; more[0] = mask.xyxy; "
          "more[1] = texture(image, gl_FragCoord.xy); }"}},
        {},
        {}};
    definition.outputs = {{3, 0, "tint"}, {1, 0, "more"}};
    definition.feedback = {GL_INTERLEAVED_ATTRIBS, {"gl_Position", "speed"}};
    const auto r = link(1, definition);
    ASSERT_TRUE(r.linked) << r.log;
    const auto find = [&](const auto& all, const std::string& name) {
        for (const auto& one : all)
            if (one.name == name) return one;
        ADD_FAILURE() << name;
        return std::decay_t<decltype(all[0])>{};
    };
    EXPECT_EQ(find(r.uniforms, "mask").initial, (std::vector<std::uint32_t>{4294967295u, 3}));
    EXPECT_EQ(find(r.uniforms, "image").type, GLenum{GL_UNSIGNED_INT_SAMPLER_2D});
    EXPECT_EQ(find(r.uniforms, "depths").type, GLenum{GL_SAMPLER_CUBE_SHADOW});
    for (const auto& uniform : r.uniforms) EXPECT_NE(glapi::find_uniform_type(uniform.type), nullptr) << uniform.name;
    ASSERT_EQ(r.blocks.size(), 2u);
    EXPECT_EQ(find(r.blocks, "Turn").stages, 1u);
    EXPECT_EQ(find(r.blocks, "Light").stages, 2u);
    EXPECT_EQ(find(r.blocks, "Light").bytes, 64u);
    const auto matrix = find(r.uniforms, "m");
    EXPECT_EQ(matrix.place.offset, 16);
    EXPECT_EQ(matrix.place.matrix_stride, 16);
    EXPECT_TRUE(matrix.place.row_major);
    EXPECT_EQ(r.blocks[static_cast<std::size_t>(matrix.place.block)].name, "Light");
    EXPECT_TRUE(find(r.uniforms, "Turn.a").array);
    EXPECT_EQ(find(r.outputs, "tint").location, 3);
    EXPECT_EQ(find(r.outputs, "more").location, 1);
    EXPECT_EQ(find(r.outputs, "more").size, 2u);
    EXPECT_EQ(find(r.attributes, "place").location, 5);
    EXPECT_EQ(find(r.attributes, "gl_VertexID").location, -1);
    ASSERT_EQ(r.captured.size(), 2u);
    EXPECT_EQ(r.captured[1].name, "speed");
    EXPECT_EQ(r.captured[1].type, GLenum{GL_FLOAT_VEC3});
    EXPECT_EQ(find(r.uniforms, "color").initial.size(), 0u);
}

template <class All>
auto named(const All& all, const std::string& name) {
    for (const auto& one : all)
        if (one.name == name) return one;
    ADD_FAILURE() << name;
    return std::decay_t<decltype(all[0])>{};
}

TEST_F(ProgramsTest, LocationsOfUniformsAreThoseOfTheShader) {
    const char* fragment =
        "#version 430\nlayout(location = 9) uniform float one; layout(location = 20) uniform vec2 many[3];\n"
        "layout(location = 3) uniform vec4 unused[2]; uniform float other; uniform int last; out vec4 color;\n"
        "void main() { color = vec4(one + other, many[0] + many[2], gl_FragCoord.x * float(last)); }";
    glapi::ProgramDefinition definition = with_fragment(fragment);
    const auto r = link(1, definition);
    ASSERT_TRUE(r.linked) << r.log;
    EXPECT_EQ(named(r.uniforms, "one").location, 9);
    EXPECT_EQ(named(r.uniforms, "many").location, 20);
    EXPECT_EQ(named(r.uniforms, "one").stages, 2u);
    EXPECT_GE(named(r.uniforms, "other").location, 0);
    EXPECT_EQ(r.unused_locations, (std::vector<std::uint32_t>{3, 4}));
    EXPECT_TRUE(set(1, 9, GL_FLOAT, 1, {1}));
    EXPECT_TRUE(set(1, 21, GL_FLOAT_VEC2, 2, {1, 1, 1, 1}));
    EXPECT_TRUE(set(1, 5, GL_FLOAT, 1, {1})) << "there is nothing";
    EXPECT_FALSE(set(1, 23, GL_FLOAT, 1, {1}));
    const auto numbered = glapi::number_uniforms(r.uniforms);
    ASSERT_TRUE(numbered);
    definition.uniforms = *numbered;  // as another node gets it
    ASSERT_TRUE(link(2, definition).linked);
    EXPECT_TRUE(set(2, 9, GL_FLOAT, 1, {1}));
}

TEST_F(ProgramsTest, RefusesLocationsFarAway) {
    glapi::ProgramDefinition definition = with_fragment("void main() { gl_FragColor = vec4(1.0); }");
    definition.uniforms = {{1, "far", glapi::kMostUniformLocations}};
    EXPECT_FALSE(program(1).link(encode(definition), false));
    definition.uniforms = {{~0u, "long", ~0u}};
    EXPECT_FALSE(program(1).link(encode(definition), false));
    definition.uniforms = {{1, "last", glapi::kMostUniformLocations - 1}};
    EXPECT_TRUE(program(1).link(encode(definition), false));
}

TEST_F(ProgramsTest, ReflectsWhatLiesInBuffers) {
    const char* fragment =
        "#version 430\nstruct Item { float weight; vec2 at[2]; };\n"
        "layout(std430, binding = 3) buffer Items { int total; Item items[]; } all[2];\n"
        "layout(binding = 1, offset = 4) uniform atomic_uint hits; out vec4 color;\n"
        "void main() { color = vec4(all[0].items[1].at[1], all[1].items[2].weight, "
        "float(atomicCounterIncrement(hits)));"
        " all[1].total = 3; }";
    const auto r = link(1, with_fragment(fragment));
    ASSERT_TRUE(r.linked) << r.log;
    ASSERT_EQ(r.storage_blocks.size(), 2u);
    EXPECT_EQ(r.storage_blocks[0].name, "Items[0]");
    const auto at = named(r.buffer_variables, "Items.items[0].at");
    EXPECT_EQ(at.type, GLenum{GL_FLOAT_VEC2});
    EXPECT_EQ(at.size, 2u);
    EXPECT_TRUE(at.array);
    EXPECT_EQ(at.top_size, 0u) << "as long as the buffer";
    EXPECT_EQ(at.top_stride, 24u);
    EXPECT_EQ(at.place.offset, 16);
    EXPECT_EQ(at.place.array_stride, 8);
    EXPECT_EQ(at.stages, 2u);
    EXPECT_EQ(named(r.buffer_variables, "Items.total").top_size, 1u);
    ASSERT_EQ(r.counter_buffers.size(), 1u);
    EXPECT_EQ(r.counter_buffers[0].binding, 1u);
    EXPECT_EQ(named(r.uniforms, "hits").place.offset, 4);
}

TEST_F(ProgramsTest, ReflectsWhatGoesThroughSeparablePrograms) {
    glapi::ProgramDefinition fragments;
    fragments.shaders = {{GL_FRAGMENT_SHADER, true,
                          "#version 430\nlayout(location = 2) in vec3 speed; layout(location = 1) out vec4 tint;\n"
                          "void main() { tint = vec4(speed, 1.0); }"}};
    fragments.separable = true;
    const auto r = link(1, fragments);
    ASSERT_TRUE(r.linked) << r.log;
    EXPECT_EQ(named(r.attributes, "speed").location, 2);
    EXPECT_EQ(named(r.attributes, "speed").stages, 2u);
    EXPECT_EQ(named(r.outputs, "tint").location, 1);
    EXPECT_TRUE(named(r.outputs, "tint").color());
    EXPECT_EQ(named(r.outputs, "tint").type, GLenum{GL_FLOAT_VEC4});

    glapi::ProgramDefinition vertices;
    vertices.shaders = {{GL_VERTEX_SHADER, true,
                         "#version 430\nin vec4 place; layout(location = 2) out vec3 speed; out gl_PerVertex { vec4 "
                         "gl_Position; };\nvoid main() { speed = place.xyz; gl_Position = place; }"}};
    vertices.separable = true;
    const auto v = link(2, vertices);
    ASSERT_TRUE(v.linked) << v.log;
    EXPECT_EQ(named(v.outputs, "speed").location, 2);
    EXPECT_FALSE(named(v.outputs, "speed").color());
    EXPECT_EQ(named(v.outputs, "speed").stages, 1u);
}

TEST_F(ProgramsTest, ReflectsWhereVaryingsAreCaptured) {
    glapi::ProgramDefinition definition;
    definition.shaders = {{GL_VERTEX_SHADER, true,
                           "#version 440\nlayout(xfb_buffer = 0, xfb_stride = 32) out; in vec4 place;\n"
                           "layout(xfb_offset = 16) out vec3 speed;\nlayout(xfb_offset = 4) out float heat;\n"
                           "void main() { speed = place.xyz; heat = place.w; gl_Position = place; }"}};
    const auto r = link(1, definition);
    ASSERT_TRUE(r.linked) << r.log;
    ASSERT_EQ(r.capture_buffers.size(), 1u);
    EXPECT_EQ(r.capture_buffers[0], (glapi::CaptureBuffer{0, 32}));
    EXPECT_EQ(named(r.captured, "speed").offset, 16u);
    EXPECT_EQ(named(r.captured, "heat").offset, 4u);
    EXPECT_EQ(named(r.captured, "heat").buffer, 0);
}

TEST_F(ProgramsTest, AProgramThatDoesNotLinkLeavesTheEarlierOne) {
    EXPECT_TRUE(link(1, with_fragment("void main() { gl_FragColor = vec4(1.0); }")).linked);
    const auto failed = link(1, with_fragment("void main() { gl_FragColor = undefined(); }"));
    EXPECT_FALSE(failed.linked);
    EXPECT_FALSE(failed.log.empty());
    const geom::Rect all{0, 0, 8, 8};
    EXPECT_EQ(draw(1, {all, all, 8, 8})[0], 255);
}

TEST_F(ProgramsTest, UniformsGoByTheClientsLocations) {
    glapi::ProgramDefinition definition = with_fragment(
        "uniform vec3 low; uniform float high[2];\nvoid main() { gl_FragColor = vec4(low.x, high[0], high[1], 1.0); }");
    definition.uniforms = {{2, "high", 0}, {1, "gone", 2}, {1, "low", 3}};  // another node listed them so
    ASSERT_TRUE(link(1, definition).linked);
    EXPECT_TRUE(set(1, 0, GL_FLOAT, 2, {0.2f, 0.4f}));
    EXPECT_TRUE(set(1, 1, GL_FLOAT, 1, {0.6f}));
    EXPECT_TRUE(set(1, 2, GL_FLOAT, 1, {1})) << "not active here";
    EXPECT_TRUE(set(1, 3, GL_FLOAT_VEC3, 1, {1, 0, 0}));
    const geom::Rect all{0, 0, 8, 8};
    const auto pixels = draw(1, {all, all, 8, 8});
    EXPECT_EQ(pixels[0], 255);
    EXPECT_EQ(pixels[1], 51);
    EXPECT_EQ(pixels[2], 153);
}

TEST_F(ProgramsTest, RefusesWhatNoClientSends) {
    ASSERT_TRUE(link(1, with_fragment("uniform vec4 color; void main() { gl_FragColor = color; }")).linked);
    EXPECT_FALSE(set(2, 0, GL_FLOAT_VEC4, 1, {0, 0, 0, 0}));
    EXPECT_FALSE(set(1, 1, GL_FLOAT_VEC4, 1, {0, 0, 0, 0}));
    EXPECT_FALSE(set(1, 0, GL_FLOAT_VEC4, 2, {0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_FALSE(set(1, 0, GL_FLOAT_VEC4, 1, {0, 0, 0}));
    EXPECT_FALSE(set(1, 0, 0x1234, 1, {0}));
    const auto bytes = encode(with_fragment("void main() {}"));
    for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(program(3).link(std::span(bytes).first(n), false)) << n;
}

constexpr const char* kStripes =
    "void main() { gl_FragColor = vec4(fract(gl_FragCoord.x / 16.0), fract(gl_FragCoord.y / 16.0), gl_FragCoord.x / "
    "64.0, 1.0); }";

TEST_F(ProgramsTest, FragCoordIsTheWindows) {
    ASSERT_TRUE(link(1, with_fragment(kStripes)).linked);
    const geom::Rect surface{10, 20, 48, 40};
    const auto whole = draw(1, {surface, surface, 48, 40});
    const geom::Rect part{21, 27, 19, 22};
    const auto piece = draw(1, {surface, part, 48, 40});
    const int left = part.x - surface.x, bottom = surface.bottom() - part.bottom();
    for (int y = 0; y < part.height; ++y)
        EXPECT_EQ(std::memcmp(&piece[static_cast<std::size_t>(y * part.width) * 4],
                              &whole[static_cast<std::size_t>((y + bottom) * 48 + left) * 4],
                              static_cast<std::size_t>(part.width) * 4),
                  0)
            << "row " << y;
}

TEST_F(ProgramsTest, FragCoordIsScaledWithTheWindow) {
    ASSERT_TRUE(
        link(1, with_fragment("void main() { gl_FragColor = vec4(gl_FragCoord.xy / 32.0, 0.0, 1.0); }")).linked);
    const geom::Rect surface{0, 0, 64, 64};
    const auto pixels = draw(1, {surface, surface, 32, 32});
    const std::uint8_t* last = &pixels[(64 * 64 - 1) * 4];
    EXPECT_NEAR(last[0], 63.5 / 64 * 255, 1);
    EXPECT_NEAR(last[1], 63.5 / 64 * 255, 1);
}

}  // namespace
}  // namespace wall::tileserver
