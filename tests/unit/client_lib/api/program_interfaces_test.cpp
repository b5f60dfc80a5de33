// SPDX-License-Identifier: MIT
// What programs say of their interfaces: names, indices, values, locations, and the errors
// (GL_ARB_program_interface_query).
#include <cstring>
#include <string>
#include <vector>

#include "client_lib/objects/program.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

constexpr std::uint32_t kVertexBit = 1, kFragmentBit = 2;

glapi::ProgramReflection reflection() {
    glapi::ProgramReflection r;
    r.linked = true;
    r.uniforms = {{GL_FLOAT_VEC4, 2, false, true, "colors", std::vector<std::uint32_t>(8), {}, -1, 5, kFragmentBit},
                  {GL_FLOAT_MAT4, 1, false, false, "Place.turn", {}, {0, 16, -1, 16, true}, -1, -1, kVertexBit},
                  {GL_UNSIGNED_INT_ATOMIC_COUNTER, 1, false, false, "hits", {}, {-1, 8, 0, 0, false}, 0}};
    r.blocks = {{"Place[0]", 80, 2, kVertexBit}, {"Place[1]", 80, 3, kVertexBit}};
    r.attributes = {{GL_FLOAT_MAT3, 2, 3, "corners[0]", kVertexBit}, {GL_INT, 1, -1, "gl_VertexID", kVertexBit}};
    r.outputs = {{2, 1, 3, true, "tint", GL_FLOAT_VEC4, kFragmentBit},
                 {-1, -1, 1, false, "gl_FragDepth", GL_FLOAT, kFragmentBit}};
    r.captured = {{GL_FLOAT_VEC3, 1, "speed", 0, 0}, {GL_NONE, 0, "gl_NextBuffer"}, {GL_FLOAT, 2, "all", 4, 1}};
    r.capture_buffers = {{0, 12}, {1, 16}};
    r.subroutines = {{GL_FRAGMENT_SHADER, {"red", "blue"}, {{"tone", 3, true, 4, {1, 0}}}, 7}};
    r.storage_blocks = {{{"Sums", 96, 1, kFragmentBit}, true}};
    r.buffer_variables = {{GL_FLOAT, 1, false, "Sums.total", {0, 0, 0, 0, false}, 1, 0, kFragmentBit},
                          {GL_INT_VEC2, 0, true, "Sums.list[0].at", {0, 16, 8, 0, false}, 0, 24, kFragmentBit}};
    r.counter_buffers = {{6, 12, kFragmentBit}};
    return r;
}

class ProgramInterfaces : public ContextTest {
protected:
    void SetUp() override {
        ContextTest::SetUp();
        name_ = gl().CreateProgram(c);
        program_ = std::static_pointer_cast<Program>(share->glsl_objects.find(name_));
        glapi::ProgramDefinition definition;
        definition.shaders = {{GL_VERTEX_SHADER, true, ""}, {GL_FRAGMENT_SHADER, true, ""}};
        program_->executable = Executable::make(definition, reflection());
        ASSERT_TRUE(program_->executable);
        program_->linked = true;
    }
    GLint of_interface(GLenum interface, GLenum word) {
        GLint value = -99;
        gl().GetProgramInterfaceiv(c, name_, interface, word, &value);
        return value;
    }
    std::vector<GLint> values(GLenum interface, GLuint index, const std::vector<GLenum>& words) {
        std::vector<GLint> out(16, -99);
        GLsizei written = -1;
        gl().GetProgramResourceiv(c, name_, interface, index, static_cast<GLsizei>(words.size()), words.data(),
                                  static_cast<GLsizei>(out.size()), &written, out.data());
        out.resize(written < 0 ? 0 : static_cast<std::size_t>(written));
        return out;
    }
    std::string name_of(GLenum interface, GLuint index) {
        GLchar text[64] = "none";
        gl().GetProgramResourceName(c, name_, interface, index, sizeof text, nullptr, text);
        return text;
    }
    GLuint index_of(GLenum interface, const char* name) {
        return gl().GetProgramResourceIndex(c, name_, interface, name);
    }
    GLint location_of(GLenum interface, const char* name) {
        return gl().GetProgramResourceLocation(c, name_, interface, name);
    }

    using Values = std::vector<GLint>;
    GLuint name_ = 0;
    std::shared_ptr<Program> program_;
};

TEST_F(ProgramInterfaces, SayHowManyThereAre) {
    const std::pair<GLenum, GLint> counts[] = {{GL_UNIFORM, 3},
                                               {GL_UNIFORM_BLOCK, 2},
                                               {GL_PROGRAM_INPUT, 2},
                                               {GL_PROGRAM_OUTPUT, 2},
                                               {GL_BUFFER_VARIABLE, 2},
                                               {GL_SHADER_STORAGE_BLOCK, 1},
                                               {GL_ATOMIC_COUNTER_BUFFER, 1},
                                               {GL_TRANSFORM_FEEDBACK_VARYING, 3},
                                               {GL_TRANSFORM_FEEDBACK_BUFFER, 2},
                                               {GL_FRAGMENT_SUBROUTINE, 2},
                                               {GL_FRAGMENT_SUBROUTINE_UNIFORM, 1},
                                               {GL_VERTEX_SUBROUTINE, 0},
                                               {GL_COMPUTE_SUBROUTINE_UNIFORM, 0}};
    for (const auto& [interface, count] : counts) EXPECT_EQ(of_interface(interface, GL_ACTIVE_RESOURCES), count);
    EXPECT_EQ(of_interface(GL_UNIFORM, GL_MAX_NAME_LENGTH), static_cast<GLint>(sizeof "Place.turn"));
    EXPECT_EQ(of_interface(GL_VERTEX_SUBROUTINE, GL_MAX_NAME_LENGTH), 0);
    EXPECT_EQ(of_interface(GL_SHADER_STORAGE_BLOCK, GL_MAX_NUM_ACTIVE_VARIABLES), 2);
    EXPECT_EQ(of_interface(GL_ATOMIC_COUNTER_BUFFER, GL_MAX_NUM_ACTIVE_VARIABLES), 1);
    EXPECT_EQ(of_interface(GL_FRAGMENT_SUBROUTINE_UNIFORM, GL_MAX_NUM_COMPATIBLE_SUBROUTINES), 2);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ProgramInterfaces, AreFoundByName) {
    EXPECT_EQ(index_of(GL_UNIFORM, "colors"), 0u);
    EXPECT_EQ(index_of(GL_UNIFORM, "colors[0]"), 0u);
    EXPECT_EQ(index_of(GL_UNIFORM, "colors[1]"), GL_INVALID_INDEX);
    EXPECT_EQ(index_of(GL_UNIFORM_BLOCK, "Place"), 0u);
    EXPECT_EQ(index_of(GL_UNIFORM_BLOCK, "Place[1]"), 1u);
    EXPECT_EQ(index_of(GL_PROGRAM_INPUT, "corners"), 0u);
    EXPECT_EQ(index_of(GL_PROGRAM_OUTPUT, "tint[0]"), 0u);
    EXPECT_EQ(index_of(GL_BUFFER_VARIABLE, "Sums.list[0].at"), 1u);
    EXPECT_EQ(index_of(GL_TRANSFORM_FEEDBACK_VARYING, "all"), 2u);
    EXPECT_EQ(index_of(GL_FRAGMENT_SUBROUTINE, "blue"), 1u);
    EXPECT_EQ(index_of(GL_FRAGMENT_SUBROUTINE_UNIFORM, "tone"), 0u);
    EXPECT_EQ(name_of(GL_UNIFORM, 0), "colors[0]");
    EXPECT_EQ(name_of(GL_BUFFER_VARIABLE, 1), "Sums.list[0].at[0]");
    EXPECT_EQ(name_of(GL_FRAGMENT_SUBROUTINE_UNIFORM, 0), "tone[0]");
    EXPECT_EQ(name_of(GL_PROGRAM_OUTPUT, 1), "gl_FragDepth");
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(index_of(GL_ATOMIC_COUNTER_BUFFER, "hits"), GL_INVALID_INDEX);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM}) << "such buffers have no names";
    EXPECT_EQ(name_of(GL_TRANSFORM_FEEDBACK_BUFFER, 0), "none");
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(name_of(GL_UNIFORM, 3), "none");
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(ProgramInterfaces, HaveValues) {
    EXPECT_EQ(values(GL_UNIFORM, 0, {GL_NAME_LENGTH, GL_TYPE, GL_ARRAY_SIZE, GL_LOCATION, GL_BLOCK_INDEX, GL_OFFSET}),
              (Values{10, GL_FLOAT_VEC4, 2, 5, -1, -1}));
    EXPECT_EQ(values(GL_UNIFORM, 0, {GL_REFERENCED_BY_VERTEX_SHADER, GL_REFERENCED_BY_FRAGMENT_SHADER}),
              (Values{0, 1}));
    EXPECT_EQ(values(GL_UNIFORM, 1, {GL_BLOCK_INDEX, GL_OFFSET, GL_MATRIX_STRIDE, GL_IS_ROW_MAJOR, GL_LOCATION}),
              (Values{0, 16, 16, 1, -1}));
    EXPECT_EQ(values(GL_UNIFORM, 2, {GL_ATOMIC_COUNTER_BUFFER_INDEX, GL_OFFSET}), (Values{0, 8}));
    EXPECT_EQ(values(GL_BUFFER_VARIABLE, 1,
                     {GL_ARRAY_SIZE, GL_TOP_LEVEL_ARRAY_SIZE, GL_TOP_LEVEL_ARRAY_STRIDE, GL_BLOCK_INDEX, GL_OFFSET}),
              (Values{0, 0, 24, 0, 16}));
    EXPECT_EQ(values(GL_PROGRAM_INPUT, 0, {GL_LOCATION, GL_ARRAY_SIZE, GL_IS_PER_PATCH, GL_LOCATION_COMPONENT}),
              (Values{3, 2, 0, 0}));
    EXPECT_EQ(values(GL_PROGRAM_OUTPUT, 0, {GL_LOCATION, GL_LOCATION_INDEX, GL_TYPE}), (Values{2, 1, GL_FLOAT_VEC4}));
    EXPECT_EQ(values(GL_PROGRAM_OUTPUT, 1, {GL_LOCATION, GL_LOCATION_INDEX}), (Values{-1, -1}));
    EXPECT_EQ(values(GL_TRANSFORM_FEEDBACK_VARYING, 2, {GL_OFFSET, GL_TRANSFORM_FEEDBACK_BUFFER_INDEX}),
              (Values{4, 1}));
    EXPECT_EQ(values(GL_FRAGMENT_SUBROUTINE, 1, {GL_NAME_LENGTH}), (Values{5}));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ProgramInterfaces, HaveListsOfWhatIsInThem) {
    EXPECT_EQ(values(GL_UNIFORM_BLOCK, 1,
                     {GL_BUFFER_BINDING, GL_BUFFER_DATA_SIZE, GL_NUM_ACTIVE_VARIABLES, GL_ACTIVE_VARIABLES}),
              (Values{3, 80, 1, 1}))
        << "each block of an array has the variables of the first";
    EXPECT_EQ(values(GL_SHADER_STORAGE_BLOCK, 0, {GL_ACTIVE_VARIABLES, GL_BUFFER_BINDING}), (Values{0, 1, 1}));
    EXPECT_EQ(values(GL_ATOMIC_COUNTER_BUFFER, 0, {GL_BUFFER_BINDING, GL_NUM_ACTIVE_VARIABLES, GL_ACTIVE_VARIABLES}),
              (Values{6, 1, 2}));
    EXPECT_EQ(values(GL_TRANSFORM_FEEDBACK_BUFFER, 1, {GL_TRANSFORM_FEEDBACK_BUFFER_STRIDE, GL_ACTIVE_VARIABLES}),
              (Values{16, 2}));
    EXPECT_EQ(values(GL_FRAGMENT_SUBROUTINE_UNIFORM, 0, {GL_COMPATIBLE_SUBROUTINES, GL_LOCATION}), (Values{1, 0, 4}));
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ProgramInterfaces, HaveLocations) {
    EXPECT_EQ(location_of(GL_UNIFORM, "colors[1]"), 6);
    EXPECT_EQ(location_of(GL_UNIFORM, "Place.turn"), -1);
    EXPECT_EQ(location_of(GL_PROGRAM_INPUT, "corners[1]"), 6) << "behind three columns";
    EXPECT_EQ(location_of(GL_PROGRAM_OUTPUT, "tint[2]"), 4);
    EXPECT_EQ(location_of(GL_PROGRAM_OUTPUT, "gl_FragDepth"), -1);
    EXPECT_EQ(location_of(GL_FRAGMENT_SUBROUTINE_UNIFORM, "tone[2]"), 6);
    EXPECT_EQ(gl().GetProgramResourceLocationIndex(c, name_, GL_PROGRAM_OUTPUT, "tint"), 1);
    EXPECT_EQ(gl().GetProgramResourceLocationIndex(c, name_, GL_PROGRAM_OUTPUT, "gl_FragDepth"), -1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(location_of(GL_UNIFORM_BLOCK, "Place"), -1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(gl().GetProgramResourceLocationIndex(c, name_, GL_UNIFORM, "colors"), -1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(ProgramInterfaces, WriteNoMoreThanThereIsRoomFor) {
    const GLenum words[] = {GL_ACTIVE_VARIABLES, GL_BUFFER_BINDING};
    GLint out[3] = {-7, -7, -7};
    GLsizei written = 0;
    gl().GetProgramResourceiv(c, name_, GL_SHADER_STORAGE_BLOCK, 0, 2, words, 1, &written, out);
    EXPECT_EQ(written, 1);
    EXPECT_EQ(out[0], 0);
    EXPECT_EQ(out[1], -7);
    gl().GetProgramResourceiv(c, name_, GL_SHADER_STORAGE_BLOCK, 0, 2, words, 0, &written, nullptr);
    EXPECT_EQ(written, 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(ProgramInterfaces, RefuseWhatTheyDoNotHave) {
    EXPECT_EQ(values(GL_UNIFORM, 0, {GL_BUFFER_BINDING}), Values());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(values(GL_PROGRAM_INPUT, 0, {GL_LOCATION_INDEX}), Values());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(values(GL_ATOMIC_COUNTER_BUFFER, 0, {GL_NAME_LENGTH}), Values());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(values(GL_UNIFORM, 0, {GL_RGBA}), Values());
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(values(GL_RGBA, 0, {GL_TYPE}), Values());
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    EXPECT_EQ(values(GL_UNIFORM, 3, {GL_TYPE}), Values());
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(values(GL_UNIFORM, 0, {}), Values());
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    for (const auto& [interface, word] : {std::pair<GLenum, GLenum>{GL_ATOMIC_COUNTER_BUFFER, GL_MAX_NAME_LENGTH},
                                          {GL_UNIFORM, GL_MAX_NUM_ACTIVE_VARIABLES},
                                          {GL_UNIFORM_BLOCK, GL_MAX_NUM_COMPATIBLE_SUBROUTINES}}) {
        EXPECT_EQ(of_interface(interface, word), -99);
        EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    }
    for (const auto& [interface, word] :
         {std::pair<GLenum, GLenum>{GL_UNIFORM, GL_TYPE}, {GL_RGBA, GL_ACTIVE_RESOURCES}}) {
        EXPECT_EQ(of_interface(interface, word), -99);
        EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION}) << "as Mesa";
    }
    name_ = 4711;
    EXPECT_EQ(of_interface(GL_UNIFORM, GL_ACTIVE_RESOURCES), -99);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
}

TEST_F(ProgramInterfaces, OfAProgramThatIsNotLinkedAreEmpty) {
    program_->linked = false;
    EXPECT_EQ(of_interface(GL_UNIFORM, GL_ACTIVE_RESOURCES), 0);
    EXPECT_EQ(index_of(GL_UNIFORM, "colors"), GL_INVALID_INDEX);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    EXPECT_EQ(location_of(GL_UNIFORM, "colors"), -1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(gl().GetProgramResourceLocationIndex(c, name_, GL_PROGRAM_OUTPUT, "tint"), -1);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
}

}  // namespace
}  // namespace wall::client
