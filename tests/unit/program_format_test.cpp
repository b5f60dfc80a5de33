// SPDX-License-Identifier: MIT
// The three values of programs on the wire: what was encoded comes back, and nothing else is taken.
#include "common/glapi/program_format.h"

#include <gtest/gtest.h>

namespace wall::glapi {
namespace {

template <class Decode>
void refuses_prefixes(const std::vector<std::byte>& bytes, Decode&& decode) {
    for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(decode(std::span(bytes).first(n))) << n;
    auto longer = bytes;
    longer.resize(bytes.size() + 4);
    EXPECT_FALSE(decode(longer));
}

const PositionProgram kPosition{
    {{"mvp", 3}},
    "place",
    false,
    {{PositionOp::uniform, 4, 4, {0}}, {PositionOp::attribute, 1, 4, {}}, {PositionOp::product, 1, 4, {0, 1}}},
    0};

TEST(ProgramFormat, Definition) {
    const ProgramDefinition in{{{GL_VERTEX_SHADER, true, "void main() {}"}, {GL_FRAGMENT_SHADER, false, ""}},
                               {{3, "place"}},
                               {{4, "lights", 7}, {1, "x"}},
                               {"Light", "Place"},
                               {{2, 1, "tint"}},
                               {GL_SEPARATE_ATTRIBS, {"speed", "gl_Position"}},
                               kPosition,
                               true,
                               {"Sums", "List[0]"},
                               {"camera", "matrices[1]"}};
    const auto bytes = encode(in);
    const auto out = decode_definition(bytes);
    ASSERT_TRUE(out);
    EXPECT_EQ(out->shaders[0].source, "void main() {}");
    EXPECT_FALSE(out->shaders[1].compiled);
    EXPECT_EQ(out->attributes[0].index, 3u);
    EXPECT_EQ(out->uniforms, in.uniforms);
    EXPECT_EQ(out->blocks, in.blocks);
    EXPECT_EQ(out->outputs, in.outputs);
    EXPECT_EQ(out->feedback.mode, GLenum{GL_SEPARATE_ATTRIBS});
    EXPECT_EQ(out->feedback.names, in.feedback.names);
    EXPECT_EQ(out->position, kPosition);
    EXPECT_TRUE(out->separable);
    EXPECT_EQ(out->storage_blocks, in.storage_blocks);
    EXPECT_EQ(out->cameras, in.cameras);
    refuses_prefixes(bytes, decode_definition);
}

TEST(ProgramFormat, Reflection) {
    const ProgramReflection in{true,
                               "fine",
                               {{GL_FLOAT_VEC2, 2, false, true, "uv", {1, 2, 3, 4}, {}, -1, 9, 3},
                                {GL_FLOAT_MAT2, 1, false, false, "m", {}, {0, 32, -1, 16, true}},
                                {GL_UNSIGNED_INT_ATOMIC_COUNTER, 1, false, false, "hits", {}, {-1, 8, 0, 0, false}, 1}},
                               {{GL_FLOAT, 1, -1, "gl_Vertex"}, {GL_FLOAT_VEC2, 3, 4, "parts[0]", 16, true, 2}},
                               {{"Light", 64, 3, 2}},
                               {{1, 0, 2, true, "tint", GL_FLOAT_VEC4, 2, true, 1}},
                               {{GL_FLOAT_VEC3, 1, "speed", 16, 0}, {GL_NONE, 0, "gl_NextBuffer"}},
                               {GL_TRIANGLES, GL_LINE_STRIP, 12, 1},
                               {4, GL_QUADS, GL_EQUAL, GL_CCW, 1},
                               {{GL_VERTEX_SHADER, {"red", "blue"}, {{"tone", 3, true, 0, {1, 0}}}, 3, {5, 0}}},
                               kPosition,
                               {{"picture", kPosition}},
                               {{{"Sums", 16, 5, 32}, false}},
                               {{1, 4, 2}, {7, 12, 33}},
                               {8, 4, 2},
                               {{GL_FLOAT, 0, true, "Sums.all[0].x", {0, 16, 4, 0, true}, 5, 64, 32}},
                               {{3, 28}},
                               {2, 11}};
    const auto bytes = encode(in);
    const auto out = decode_reflection(bytes);
    ASSERT_TRUE(out);
    EXPECT_EQ(out->log, "fine");
    EXPECT_EQ(out->uniforms[0].initial, in.uniforms[0].initial);
    EXPECT_TRUE(out->uniforms[0].array);
    EXPECT_EQ(out->attributes[0].location, -1);
    EXPECT_FALSE(out->uniforms[0].in_block());
    EXPECT_EQ(out->uniforms[1].place, in.uniforms[1].place);
    EXPECT_EQ(out->blocks[0].binding, 3u);
    EXPECT_EQ(out->outputs[0].location, 1);
    EXPECT_EQ(out->captured[0].name, "speed");
    EXPECT_EQ(out->lookups, in.lookups);
    EXPECT_EQ(out->geometry, in.geometry);
    EXPECT_EQ(out->tessellation, in.tessellation);
    ASSERT_EQ(out->subroutines.size(), 1u);
    EXPECT_EQ(out->subroutines[0].functions, in.subroutines[0].functions);
    EXPECT_EQ(out->subroutines[0].uniforms[0].compatible, in.subroutines[0].uniforms[0].compatible);
    EXPECT_EQ(out->subroutines[0].locations, 3u);
    EXPECT_EQ(out->subroutines[0].index_of(0), 5u);
    EXPECT_EQ(out->uniforms[0].counter_buffer, -1);
    EXPECT_EQ(out->uniforms[2].counter_buffer, 1);
    EXPECT_FALSE(out->uniforms[2].has_location());
    ASSERT_EQ(out->storage_blocks.size(), 1u);
    EXPECT_EQ(out->storage_blocks[0].name, "Sums");
    EXPECT_EQ(out->storage_blocks[0].stages, 32u);
    EXPECT_FALSE(out->storage_blocks[0].written);
    ASSERT_EQ(out->counter_buffers.size(), 2u);
    EXPECT_EQ(out->counter_buffers[1].bytes, 12u);
    EXPECT_EQ(out->group_size, in.group_size);
    EXPECT_EQ(out->uniforms[0].location, 9);
    EXPECT_EQ(out->uniforms[0].stages, 3u);
    EXPECT_EQ(out->uniforms[1].location, -1);
    EXPECT_EQ(out->attributes[1].stages, 16u);
    EXPECT_TRUE(out->attributes[1].patch);
    EXPECT_EQ(out->attributes[1].component, 2u);
    EXPECT_EQ(out->outputs[0].type, GLenum{GL_FLOAT_VEC4});
    EXPECT_EQ(out->outputs[0].component, 1u);
    EXPECT_EQ(out->captured[0].offset, 16u);
    EXPECT_EQ(out->captured[0].buffer, 0);
    EXPECT_EQ(out->captured[1].buffer, -1);
    ASSERT_EQ(out->buffer_variables.size(), 1u);
    EXPECT_EQ(out->buffer_variables[0].name, "Sums.all[0].x");
    EXPECT_EQ(out->buffer_variables[0].size, 0u);
    EXPECT_EQ(out->buffer_variables[0].place, in.buffer_variables[0].place);
    EXPECT_EQ(out->buffer_variables[0].top_stride, 64u);
    EXPECT_EQ(out->capture_buffers, in.capture_buffers);
    EXPECT_EQ(out->unused_locations, in.unused_locations);
    refuses_prefixes(bytes, decode_reflection);
}

ActiveUniform uniform(const char* name, std::uint32_t size, std::int32_t location) {
    ActiveUniform out;
    out.type = GL_FLOAT;
    out.size = size;
    out.name = name;
    out.location = location;
    return out;
}

TEST(ProgramFormat, LocationsThatAreToldStayAndOthersLieBehind) {
    ActiveUniform built_in = uniform("gl_Fog", 1, -1);
    built_in.built_in = true;
    const auto numbered = number_uniforms({uniform("a", 2, -1), built_in, uniform("b", 3, 7), uniform("c", 1, -1)});
    const std::vector<UniformName> expected{{2, "a", 10}, {3, "b", 7}, {1, "c", 12}};
    EXPECT_EQ(numbered, expected);
    EXPECT_EQ(number_uniforms({}), std::vector<UniformName>());
}

TEST(ProgramFormat, LocationsThatCannotBeAreRefused) {
    EXPECT_FALSE(number_uniforms({uniform("a", 2, 4), uniform("b", 1, 5)})) << "one for two";
    EXPECT_TRUE(number_uniforms({uniform("a", 2, 4), uniform("b", 1, 6)}));
    EXPECT_FALSE(number_uniforms({uniform("a", 1, static_cast<std::int32_t>(kMostUniformLocations))}));
    EXPECT_FALSE(number_uniforms({uniform("a", ~0u, 5)}));
    EXPECT_FALSE(number_uniforms({uniform("a", kMostUniformLocations, -1), uniform("b", 1, -1)}));
}

TEST(ProgramFormat, AbsurdLengthsAreRefused) {
    std::vector<std::byte> bytes(12, std::byte{0xff});
    EXPECT_FALSE(decode_definition(bytes));
    EXPECT_FALSE(decode_reflection(bytes));
    EXPECT_FALSE(decode_compile_result(bytes));
}

TEST(ProgramFormat, EveryFunctionHasAnIndex) {
    ProgramReflection in;
    in.subroutines = {{GL_VERTEX_SHADER, {"red", "blue"}, {}, 0, {5}}};
    EXPECT_FALSE(decode_reflection(encode(in)));
    in.subroutines[0].indices = {};
    EXPECT_EQ(decode_reflection(encode(in))->subroutines[0].index_of(1), 1u);
}

TEST(ProgramFormat, PositionsWithoutMeaningAreRefused) {
    ProgramReflection in;
    in.position = kPosition;
    ASSERT_TRUE(decode_reflection(encode(in)));
    in.position.steps[2].operands[1] = 2;
    EXPECT_FALSE(decode_reflection(encode(in)));
    ProgramDefinition definition;
    definition.position = in.position;
    EXPECT_FALSE(decode_definition(encode(definition)));
}

TEST(ProgramFormat, UniformTypes) {
    EXPECT_EQ(find_uniform_type(GL_FLOAT_MAT2x3)->words(), 6u);
    EXPECT_EQ(find_uniform_type(GL_DOUBLE_MAT2x3)->words(), 12u);
    EXPECT_EQ(find_uniform_type(GL_SAMPLER_CUBE)->texture_target, TextureTarget::cube_map);
    EXPECT_EQ(find_uniform_type(GL_UNSIGNED_INT_IMAGE_2D_ARRAY)->base, UniformBase::image);
    EXPECT_EQ(find_uniform_type(GL_IMAGE_BUFFER)->texture_target, TextureTarget::buffer);
    EXPECT_EQ(find_uniform_type(GL_UNSIGNED_INT_ATOMIC_COUNTER)->base, UniformBase::counter);
    EXPECT_EQ(find_uniform_type(GL_RGBA), nullptr);
}

}  // namespace
}  // namespace wall::glapi
