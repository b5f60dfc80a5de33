// SPDX-License-Identifier: MIT
// Programs and buffers as the client keeps them: what needs no node.
#include "client_lib/objects/program.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "client_lib/context/buffer_binding.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

// ---- what linking told ----

glapi::ProgramReflection reflection() {
    glapi::ProgramReflection r;
    r.linked = true;
    r.uniforms = {{GL_FLOAT_MAT4, 1, true, false, "gl_ModelViewMatrix", {}},
                  {GL_FLOAT_VEC3, 1, false, false, "color", {0, 0, 0}},
                  {GL_FLOAT, 3, false, true, "weights", {1, 2, 3}},
                  {GL_SAMPLER_2D, 2, false, true, "images", {0, 0}}};
    r.attributes = {{GL_FLOAT_VEC4, 1, 5, "place"}, {GL_FLOAT_MAT3, 2, 6, "corners"}, {GL_INT, 1, -1, "gl_VertexID"}};
    return r;
}

TEST(ExecutableTest, LocationsAreDense) {
    const auto e = Executable::make({}, reflection());
    ASSERT_TRUE(e);
    EXPECT_EQ(e->location_of("color"), 0);
    EXPECT_EQ(e->location_of("weights"), 1);
    EXPECT_EQ(e->location_of("weights[0]"), 1);
    EXPECT_EQ(e->location_of("weights[2]"), 3);
    EXPECT_EQ(e->location_of("images[1]"), 5);
    for (const char* none : {"weights[3]", "color[0]", "weights[", "weights[]", "weights[01]", "weights[-1]", "other",
                             "", "]", "gl_ModelViewMatrix"})
        EXPECT_EQ(e->location_of(none), -1) << none;
    EXPECT_EQ(e->attribute_location_of("place"), 5);
    EXPECT_EQ(e->attribute_location_of("places"), -1);
    EXPECT_EQ(e->attribute_location_of("place[0]"), -1) << "it is no array";
    EXPECT_EQ(e->attribute_location_of("corners"), 6);
    EXPECT_EQ(e->attribute_location_of("corners[0]"), 6);
    EXPECT_EQ(e->attribute_location_of("corners[1]"), 9) << "behind three columns";
    EXPECT_EQ(e->attribute_location_of("corners[2]"), -1);
    EXPECT_EQ(e->attribute_location_of("gl_VertexID"), -1);
    EXPECT_EQ(e->place_of(6), nullptr);
    EXPECT_EQ(e->place_of(-1), nullptr);
}

TEST(ExecutableTest, LookupsFollowTheUniforms) {
    using glapi::PositionOp;
    const glapi::PositionProgram shifted{
        {{"shift", 0}},
        "place",
        true,
        {{PositionOp::attribute, 1, 4, {}}, {PositionOp::uniform, 1, 4, {0}}, {PositionOp::add, 1, 4, {0, 1}}}};
    auto told = reflection();
    told.uniforms.push_back({GL_SAMPLER_2D, 1, false, false, "picture", {0}});
    told.uniforms.push_back({GL_FLOAT_VEC4, 1, false, false, "shift", {0, 0, 0, 0}});
    told.lookups = {{"images", shifted}, {"color", shifted}, {"gone", shifted}, {"picture", shifted}};
    const auto e = Executable::make({}, told);
    ASSERT_TRUE(e);
    ASSERT_EQ(e->lookups().size(), 1u) << "of a sampler that is there and no array";
    EXPECT_EQ(e->uniforms[e->lookups()[0].uniform].name, "picture");
    Uniform& shift = *std::ranges::find(e->uniforms, "shift", &Uniform::name);
    const float values[] = {0.5f, 2, 0, 0};
    std::uint32_t words[4];
    std::memcpy(words, values, sizeof words);
    e->store(shift, 0, words);
    const auto* transform = e->lookups()[0].coordinates.transform(glstate::kIdentity, glstate::kIdentity);
    ASSERT_NE(transform, nullptr);
    EXPECT_EQ(transform->constant[0], 0.5f);
    EXPECT_EQ(transform->constant[1], 2);
    EXPECT_EQ(transform->linear[0], 1);
}

TEST(ExecutableTest, LocationsAreThoseOfTheShaders) {
    auto told = reflection();
    told.uniforms[1].location = 40;
    told.uniforms[2].location = 3;
    told.unused_locations = {7, 9};
    const auto e = Executable::make({}, told);
    ASSERT_TRUE(e);
    EXPECT_EQ(e->location_of("color"), 40);
    EXPECT_EQ(e->location_of("weights[2]"), 5);
    EXPECT_EQ(e->location_of("images"), 41) << "behind all others";
    EXPECT_EQ(e->place_of(0), nullptr);
    EXPECT_EQ(e->place_of(39), nullptr);
    ASSERT_TRUE(e->place_of(5));
    EXPECT_EQ(e->place_of(5)->uniform, 2u);
    EXPECT_EQ(e->place_of(5)->element, 2u);
    EXPECT_TRUE(e->ignores(9));
    EXPECT_FALSE(e->ignores(8));
    EXPECT_FALSE(e->ignores(-1));
    EXPECT_EQ(glapi::decode_definition(e->definition)->uniforms[0], (glapi::UniformName{1, "color", 40}));
    told.uniforms[3].location = 4;
    EXPECT_FALSE(Executable::make({}, told)) << "weights[1] has it";
}

TEST(ExecutableTest, ElementsOfSamplerArraysThatWereNeverSetDoNotConflict) {
    auto told = reflection();
    told.uniforms.push_back({GL_SAMPLER_3D, 2, false, true, "volumes", {0, 0}});
    const auto e = Executable::make({}, told);
    ASSERT_TRUE(e);
    EXPECT_FALSE(e->samplers_conflict()) << "all are unit 0, and perhaps none is read";
    const auto set = [&](std::size_t uniform, std::uint32_t element, std::uint32_t unit) {
        e->store(e->uniforms[uniform], element, std::span(&unit, 1));
    };
    set(3, 1, 1);
    set(4, 1, 1);
    EXPECT_TRUE(e->samplers_conflict());
    set(4, 1, 2);
    EXPECT_FALSE(e->samplers_conflict());
    const std::uint32_t first_unit = 0;
    EXPECT_FALSE(e->holds(e->uniforms[3], 0, std::span(&first_unit, 1))) << "it was never set";
    set(3, 0, 0);
    EXPECT_TRUE(e->holds(e->uniforms[3], 0, std::span(&first_unit, 1)));
    set(4, 0, 0);
    EXPECT_TRUE(e->samplers_conflict());
}

TEST(ExecutableTest, AnArrayOfArraysHasOneForEachInnerOne) {
    glapi::ProgramReflection told;
    told.linked = true;
    told.uniforms = {{GL_FLOAT, 2, false, true, "a[0]", {0, 0}}, {GL_FLOAT, 2, false, true, "a[1]", {0, 0}}};
    const auto e = Executable::make({}, told);
    ASSERT_TRUE(e);
    EXPECT_EQ(e->location_of("a[0]"), 0);
    EXPECT_EQ(e->location_of("a[1]"), 2);
    EXPECT_EQ(e->location_of("a[1][1]"), 3);
    EXPECT_EQ(e->location_of("a[2]"), -1);
    EXPECT_EQ(e->location_of("a"), -1);
    EXPECT_EQ(e->uniform_index_of("a[1]"), 1u);
    EXPECT_EQ(e->uniform_index_of("a[1][0]"), 1u);
}

TEST(ExecutableTest, InputsOfOtherStagesAreNoAttributes) {
    glapi::ProgramDefinition definition;
    definition.shaders = {{GL_FRAGMENT_SHADER, true, ""}};
    const auto e = Executable::make(definition, reflection());
    ASSERT_TRUE(e);
    EXPECT_TRUE(e->attributes.empty());
    EXPECT_EQ(e->taken().size(), 3u);
    EXPECT_EQ(e->attribute_location_of("place"), -1);
    EXPECT_EQ(e->input_location_of("place"), 5);
    EXPECT_TRUE(glapi::decode_definition(e->definition)->attributes.empty());
}

TEST(ExecutableTest, OtherNodesGetTheFirstOnesChoices) {
    glapi::ProgramDefinition definition;
    definition.attributes = {{2, "place"}, {4, "unused"}};
    const auto e = Executable::make(definition, reflection());
    const auto sent = glapi::decode_definition(e->definition);
    ASSERT_TRUE(sent);
    ASSERT_EQ(sent->uniforms.size(), 3u);
    EXPECT_EQ(sent->uniforms[1].name, "weights");
    EXPECT_EQ(sent->uniforms[1].size, 3u);
    ASSERT_EQ(sent->attributes.size(), 3u);
    EXPECT_EQ(sent->attributes[1].name, "place");
    EXPECT_EQ(sent->attributes[1].index, 5u);
    EXPECT_EQ(sent->attributes[2].name, "corners");
}

TEST(ExecutableTest, OtherNodesAreToldHowThePositionIsMade) {
    glapi::ProgramReflection told = reflection();
    told.position = {{}, "place", true, {{glapi::PositionOp::attribute, 1, 4, {}}}};
    const auto e = Executable::make({}, told);
    EXPECT_EQ(glapi::decode_definition(e->definition)->position, told.position);
    EXPECT_EQ(e->position_attribute(), 5);
    EXPECT_EQ(Executable::make({}, reflection())->position_attribute(), -1);
}

TEST(ExecutableTest, StampsTellWhatANodeLacks) {
    Program program(ClientName(1), 1);
    program.executable = Executable::make({}, reflection());
    Executable& e = *program.executable;
    wire::PackBuffer first;
    program.pack_changes(0, first, no_limit);
    EXPECT_EQ(first.commands(), 1u);  // the definition; no uniform was set
    const std::uint64_t known = e.last_change;
    const std::uint32_t word = 7;
    EXPECT_FALSE(e.holds(e.uniforms[2], 1, std::span(&word, 1)));
    e.store(e.uniforms[2], 1, std::span(&word, 1));
    EXPECT_TRUE(e.holds(e.uniforms[2], 1, std::span(&word, 1)));
    wire::PackBuffer change, all;
    program.pack_changes(known, change, no_limit);
    EXPECT_EQ(change.commands(), 1u);
    program.pack_changes(0, all, no_limit);
    EXPECT_EQ(all.commands(), 2u);
    program.pack_changes(e.last_change, change, no_limit);
    EXPECT_EQ(change.commands(), 1u);
}

TEST(ExecutableTest, RefusesAnAnswerThatContradictsItself) {
    auto bad = reflection();
    bad.uniforms[1].initial.pop_back();
    EXPECT_FALSE(Executable::make({}, std::move(bad)));
    bad = reflection();
    bad.uniforms[2].size = 0;
    EXPECT_FALSE(Executable::make({}, std::move(bad)));
    bad = reflection();
    bad.uniforms[1].type = 0x1234;
    EXPECT_FALSE(Executable::make({}, std::move(bad)));
    bad = reflection();
    bad.buffer_variables = {{GL_FLOAT, 1, false, "x", {0, 0, 0, 0, false}}};
    EXPECT_FALSE(Executable::make({}, bad)) << "there is no such block";
    bad.storage_blocks = {{{"Block", 16, 0, 1}, true}};
    EXPECT_TRUE(Executable::make({}, bad));
    bad.buffer_variables[0].place.block = -1;
    EXPECT_FALSE(Executable::make({}, bad));
    bad = reflection();
    bad.captured = {{GL_FLOAT, 1, "x", 0, 1}};
    bad.capture_buffers = {{0, 4}};
    EXPECT_FALSE(Executable::make({}, bad)) << "there is no such buffer";
}

// ---- the API ----

class ProgramTest : public ContextTest {
protected:
    /// A program that is linked and used, as if a node had answered.
    Program& use() {
        name_ = gl().CreateProgram(c);
        const auto program = std::static_pointer_cast<Program>(share->glsl_objects.find(name_));
        program->executable = Executable::make({}, reflection());
        program->linked = true;
        gl().UseProgram(c, name_);
        return *program;
    }
    GLuint name_ = 0;
};

TEST_F(ProgramTest, NamesAreShared) {
    const GLuint shader = gl().CreateShader(c, GL_VERTEX_SHADER), program = gl().CreateProgram(c);
    EXPECT_NE(shader, program);
    EXPECT_TRUE(gl().IsShader(c, shader));
    EXPECT_FALSE(gl().IsProgram(c, shader));
    gl().AttachShader(c, shader, shader);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().AttachShader(c, 99, shader);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(gl().CreateShader(c, GL_FLOAT), 0u);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(ProgramTest, AnAttachedShaderOutlivesItsDeletion) {
    const GLuint shader = gl().CreateShader(c, GL_VERTEX_SHADER), program = gl().CreateProgram(c);
    gl().AttachShader(c, program, shader);
    gl().AttachShader(c, program, shader);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().DeleteShader(c, shader);
    GLint deleted = 0;
    gl().GetShaderiv(c, shader, GL_DELETE_STATUS, &deleted);
    EXPECT_EQ(deleted, GL_TRUE);
    gl().DetachShader(c, program, shader);
    EXPECT_FALSE(gl().IsShader(c, shader));
}

TEST_F(ProgramTest, SourceIsKeptAsGiven) {
    const GLuint shader = gl().CreateShader(c, GL_VERTEX_SHADER);
    const GLchar* parts[] = {"abc", "defgh"};
    const GLint lengths[] = {-1, 2};
    gl().ShaderSource(c, shader, 2, parts, lengths);
    GLchar out[8];
    GLsizei length = 0;
    gl().GetShaderSource(c, shader, sizeof out, &length, out);
    EXPECT_STREQ(out, "abcde");
    EXPECT_EQ(length, 5);
    gl().GetShaderSource(c, shader, 3, &length, out);
    EXPECT_STREQ(out, "ab");
}

TEST_F(ProgramTest, UniformsKeepTheirTypes) {
    Program& program = use();
    EXPECT_EQ(c.state.objects.current_program, program.id.value);
    gl().Uniform3f(c, 0, 1, 2, 3);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    GLfloat got[3] = {};
    gl().GetUniformfv(c, name_, 0, got);
    EXPECT_EQ(got[2], 3);
    gl().Uniform2f(c, 0, 1, 2);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().Uniform3i(c, 0, 1, 2, 3);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().Uniform1i(c, 4, 9999);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().Uniform1f(c, 77, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().Uniform1f(c, -1, 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    const GLfloat many[4] = {9, 8, 7, 6};
    gl().Uniform1fv(c, 2, 4, many);  // reaches over the end: cut
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().GetUniformfv(c, name_, 3, got);
    EXPECT_EQ(got[0], 8);
    gl().GetUniformfv(c, name_, 1, got);
    GLint initial = 0;
    std::memcpy(&initial, got, sizeof initial);
    EXPECT_EQ(initial, 1);
}

TEST_F(ProgramTest, LocationsOfUniformsThatAreNotActiveAreIgnored) {
    Program& program = use();
    auto told = reflection();
    told.unused_locations = {9};
    program.executable = Executable::make({}, told);
    gl().Uniform1f(c, 9, 1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().Uniform1f(c, 10, 1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    GLfloat got = 0;
    gl().GetUniformfv(c, name_, 9, &got);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(ProgramTest, AnEqualValueIsNoChange) {
    Program& program = use();
    gl().Uniform3f(c, 0, 1, 2, 3);
    const auto stamp = program.executable->last_change;
    gl().Uniform3f(c, 0, 1, 2, 3);
    EXPECT_EQ(program.executable->last_change, stamp);
    gl().Uniform3f(c, 0, 1, 2, 4);
    EXPECT_GT(program.executable->last_change, stamp);
}

TEST_F(ProgramTest, AProgramDrawsEverywhere) {
    use();
    gl().Begin(c, GL_POINTS);
    gl().Vertex2f(c, 0, 0);
    gl().End(c);
    EXPECT_TRUE(c.packer.block_box().unbounded());
    c.packer.reset();
}

// ---- buffers ----

using BufferTest = ContextTest;

TEST_F(BufferTest, HoldsWhatItWasGiven) {
    GLuint name = 0;
    gl().GenBuffers(c, 1, &name);
    EXPECT_FALSE(gl().IsBuffer(c, name));
    gl().BufferData(c, GL_ARRAY_BUFFER, 4, "abcd", GL_STATIC_DRAW);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindBuffer(c, GL_ARRAY_BUFFER, name);
    EXPECT_TRUE(gl().IsBuffer(c, name));
    gl().BufferData(c, GL_ARRAY_BUFFER, 4, "abcd", GL_STATIC_DRAW);
    gl().BufferSubData(c, GL_ARRAY_BUFFER, 1, 2, "XY");
    char got[4];
    gl().GetBufferSubData(c, GL_ARRAY_BUFFER, 0, 4, got);
    EXPECT_EQ(std::memcmp(got, "aXYd", 4), 0);
    gl().BufferSubData(c, GL_ARRAY_BUFFER, 3, 2, "XY");
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().BufferData(c, GL_ARRAY_BUFFER, 4, "abcd", GL_FLOAT);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(buffer_content(c, ClientName(c.state.local.array_buffer), 2).bytes().size(), 2u);
    EXPECT_TRUE(buffer_content(c, ClientName(c.state.local.array_buffer), 5).bytes().empty());
}

TEST_F(BufferTest, MappedMemoryIsTheContent) {
    GLuint name = 0;
    gl().GenBuffers(c, 1, &name);
    gl().BindBuffer(c, GL_ARRAY_BUFFER, name);
    gl().BufferData(c, GL_ARRAY_BUFFER, 4, nullptr, GL_DYNAMIC_DRAW);
    auto* memory = static_cast<char*>(gl().MapBuffer(c, GL_ARRAY_BUFFER, GL_WRITE_ONLY));
    ASSERT_TRUE(memory);
    GLint alignment = 0;
    gl().GetIntegerv(c, GL_MIN_MAP_BUFFER_ALIGNMENT, &alignment);
    EXPECT_EQ(alignment, 64);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % 64, 0u);
    std::memcpy(memory, "wxyz", 4);
    EXPECT_EQ(gl().MapBuffer(c, GL_ARRAY_BUFFER, GL_WRITE_ONLY), nullptr);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_TRUE(gl().UnmapBuffer(c, GL_ARRAY_BUFFER));
    char got[4];
    gl().GetBufferSubData(c, GL_ARRAY_BUFFER, 0, 4, got);
    EXPECT_EQ(std::memcmp(got, "wxyz", 4), 0);
    EXPECT_FALSE(gl().UnmapBuffer(c, GL_ARRAY_BUFFER));
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

TEST_F(BufferTest, DeletingUnbinds) {
    GLuint name = 0;
    gl().GenBuffers(c, 1, &name);
    gl().BindBuffer(c, GL_ELEMENT_ARRAY_BUFFER, name);
    gl().DeleteBuffers(c, 1, &name);
    EXPECT_EQ(c.state.vertex_arrays.element_array_buffer, 0u);
    EXPECT_FALSE(gl().IsBuffer(c, name));
}

}  // namespace
}  // namespace wall::client
