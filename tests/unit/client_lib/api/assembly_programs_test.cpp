// SPDX-License-Identifier: MIT
// Assembly programs in a context: names, parameters, limits and errors; what is drawn with, where vertices go, and
// which objects that takes; matrices that only such programs read.
#include <array>

#include "client_lib/context/assembly_binding.h"
#include "client_lib/context/program_use.h"
#include "client_lib/context/texture_binding.h"
#include "client_lib/context/used_objects.h"
#include "client_lib/objects/program.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

using glapi::AssemblyStage;
using glapi::PositionOp;
constexpr GLenum kVertex = GL_VERTEX_PROGRAM_ARB, kFragment = GL_FRAGMENT_PROGRAM_ARB;

class AssemblyPrograms : public ContextTest {
protected:
    /// As if a node had compiled it.
    void load(AssemblyStage stage, glapi::AssemblyReflection reflection = {}) {
        const auto program = make_bound_assembly(c, stage);
        std::lock_guard lock(share->mutex);
        reflection.compiled = true;
        reflection.counts.resize(std::size(glapi::kAssemblyWords));
        program->load("text", std::move(reflection));
        share->last_change = program->latest();
    }
    GLint value(GLenum target, GLenum pname) {
        GLint out = -1;
        gl().GetProgramivARB(c, target, pname, &out);
        return out;
    }
    std::array<GLfloat, 4> environment(GLenum target, GLuint index) {
        std::array<GLfloat, 4> out{};
        gl().GetProgramEnvParameterfvARB(c, target, index, out.data());
        return out;
    }
    std::array<GLfloat, 4> local(GLenum target, GLuint index) {
        std::array<GLfloat, 4> out{};
        gl().GetProgramLocalParameterfvARB(c, target, index, out.data());
        return out;
    }
    bool uses(ClientName id) {
        bool found = false;
        for_each_used(c, [&](const Object& object) { found = found || object.id == id; });
        return found;
    }
    /// vertex + env[1]
    static glapi::AssemblyReflection shifting() {
        glapi::AssemblyReflection out;
        out.position = {
            {{"env", 1}},
            "gl_Vertex",
            true,
            {{PositionOp::attribute, 1, 4, {}}, {PositionOp::uniform, 1, 4, {0}}, {PositionOp::add, 1, 4, {0, 1}}}};
        return out;
    }
};

TEST_F(AssemblyPrograms, NamesAreOfOneTargetOnceTheyAreBound) {
    GLuint names[2];
    gl().GenProgramsARB(c, 2, names);
    EXPECT_FALSE(gl().IsProgramARB(c, names[0]));
    gl().BindProgramARB(c, kVertex, names[0]);
    EXPECT_TRUE(gl().IsProgramARB(c, names[0]));
    EXPECT_EQ(value(kVertex, GL_PROGRAM_BINDING_ARB), static_cast<GLint>(names[0]));
    gl().BindProgramARB(c, kFragment, names[0]);
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(value(kFragment, GL_PROGRAM_BINDING_ARB), 0);
    gl().DeleteProgramsARB(c, 2, names);
    EXPECT_FALSE(gl().IsProgramARB(c, names[0]));
    EXPECT_EQ(value(kVertex, GL_PROGRAM_BINDING_ARB), 0);
    gl().BindProgramARB(c, GL_TEXTURE_2D, 0);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(AssemblyPrograms, ContextsOfAGroupShareThem) {
    Context other(share);
    gl().BindProgramARB(c, kVertex, 5);
    load(AssemblyStage::vertex);
    other.table->BindProgramARB(other, kVertex, 5);
    other.table->ProgramLocalParameter4fARB(other, kVertex, 2, 1, 2, 3, 4);
    EXPECT_EQ(local(kVertex, 2), (std::array<GLfloat, 4>{1, 2, 3, 4}));
    other.table->ProgramEnvParameter4fARB(other, kVertex, 2, 1, 2, 3, 4);
    EXPECT_EQ(environment(kVertex, 2), (std::array<GLfloat, 4>{})) << "each has its own environment";
    gl().BindProgramARB(c, kVertex, 0);
    load(AssemblyStage::vertex);
    GLint length = 0;
    other.table->BindProgramARB(other, kVertex, 0);
    other.table->GetProgramivARB(other, kVertex, GL_PROGRAM_LENGTH_ARB, &length);
    EXPECT_EQ(length, 4) << "the default program, too";
}

TEST_F(AssemblyPrograms, ParametersInEveryForm) {
    gl().ProgramEnvParameter4fARB(c, kFragment, 3, 1, 2, 3, 4);
    EXPECT_EQ(environment(kFragment, 3), (std::array<GLfloat, 4>{1, 2, 3, 4}));
    EXPECT_EQ(environment(kVertex, 3), (std::array<GLfloat, 4>{}));
    const GLfloat several[] = {1, 0, 0, 0, 0, 2, 0, 0};
    gl().ProgramEnvParameters4fvEXT(c, kVertex, 10, 2, several);
    EXPECT_EQ(environment(kVertex, 11), (std::array<GLfloat, 4>{0, 2, 0, 0}));
    gl().ProgramLocalParameters4fvEXT(c, kVertex, 10, 2, several);
    EXPECT_EQ(local(kVertex, 10), (std::array<GLfloat, 4>{1, 0, 0, 0}));
    GLdouble doubles[4];
    gl().GetProgramLocalParameterdvARB(c, kVertex, 11, doubles);
    EXPECT_EQ(doubles[1], 2);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(AssemblyPrograms, ParametersThatThereAreNot) {
    const auto most = static_cast<GLuint>(value(kFragment, GL_MAX_PROGRAM_ENV_PARAMETERS_ARB));
    EXPECT_EQ(most, 24u) << "what every driver has, as no node has said";
    gl().ProgramEnvParameter4fARB(c, kFragment, most, 1, 2, 3, 4);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().ProgramLocalParameter4fARB(c, GL_TEXTURE_2D, 0, 1, 2, 3, 4);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    const GLfloat several[8] = {};
    gl().ProgramEnvParameters4fvEXT(c, kFragment, most - 1, 2, several);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().ProgramLocalParameters4fvEXT(c, kFragment, 0, 0, several);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().ProgramLocalParameters4fvEXT(c, kFragment, ~0u, 2, several);
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    EXPECT_EQ(value(kFragment, GL_MAX_PROGRAM_ADDRESS_REGISTERS_ARB), -1) << "of vertices only";
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
    GLint whole[2] = {-1, -1};
    gl().GetIntegerv(c, GL_MAX_PROGRAM_INSTRUCTIONS_ARB, whole);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM}) << "not of a target";
}

TEST_F(AssemblyPrograms, OneWithoutAStringDrawsNothing) {
    gl().Enable(c, kVertex);
    EXPECT_FALSE(may_draw(c));
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    load(AssemblyStage::vertex);
    EXPECT_TRUE(may_draw(c));
    gl().Enable(c, kFragment);
    gl().RasterPos4f(c, 0, 0, 0, 1);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR}) << "only vertices are looked at";
    gl().BindProgramARB(c, kFragment, 9);
    EXPECT_FALSE(may_draw(c));
    error();
    gl().BindProgramARB(c, kFragment, 0);
    load(AssemblyStage::fragment);
    EXPECT_TRUE(may_draw(c));
}

TEST_F(AssemblyPrograms, AShaderTakesThePlaceOfOne) {
    gl().Enable(c, kVertex);
    gl().Enable(c, kFragment);
    c.program = std::make_shared<Program>(ClientName(1), 1);
    c.program->executable = std::make_unique<Executable>();
    c.program->executable->stages = 1;
    EXPECT_FALSE(draws_with_assembly(c, AssemblyStage::vertex));
    EXPECT_TRUE(draws_with_assembly(c, AssemblyStage::fragment));
    c.program->executable->stages = 3;
    EXPECT_TRUE(may_use_assembly(c)) << "though neither has a string";
}

TEST_F(AssemblyPrograms, VerticesGoWhereItsPositionSays) {
    load(AssemblyStage::vertex, shifting());
    EXPECT_EQ(c.placing().projection.clip_from_object, glstate::kIdentity) << "it is not switched on";
    gl().Enable(c, kVertex);
    EXPECT_TRUE(c.placing().of_vertices());
    gl().ProgramEnvParameter4fARB(c, kVertex, 1, 5, 0, 0, 0);
    EXPECT_EQ(c.placing().projection.clip_from_object[12], 5);
    EXPECT_FALSE(c.placing().homogeneous);
    gl().ProgramEnvParameter4fARB(c, kVertex, 1, 6, 0, 0, 0);
    EXPECT_EQ(c.placing().projection.clip_from_object[12], 6);
    load(AssemblyStage::vertex);
    EXPECT_FALSE(c.placing().known);
    gl().Disable(c, kVertex);
    EXPECT_TRUE(c.placing().known);
}

TEST_F(AssemblyPrograms, AnInvariantOneIsFixedFunction) {
    auto reflection = shifting();
    reflection.invariant = true;
    load(AssemblyStage::vertex, reflection);
    gl().Enable(c, kVertex);
    gl().Translatef(c, 3, 0, 0);
    EXPECT_TRUE(c.placing().of_vertices());
    EXPECT_FALSE(c.placing().projection.by_shader);
    EXPECT_EQ(c.placing().projection.clip_from_object[12], 3);
}

TEST_F(AssemblyPrograms, ItsTexturesAreUsed) {
    glapi::AssemblyReflection reflection;
    reflection.textures = {{2, glapi::TextureTarget::t3d}};
    load(AssemblyStage::fragment, reflection);
    gl().ActiveTexture(c, GL_TEXTURE2);
    gl().BindTexture(c, GL_TEXTURE_3D, 4);
    const auto texture = texture_to_change(c, GL_TEXTURE_3D);
    const ClientName program = make_bound_assembly(c, AssemblyStage::fragment)->id;
    EXPECT_FALSE(uses(texture->id) || uses(program));
    gl().Enable(c, kFragment);
    EXPECT_TRUE(uses(texture->id) && uses(program));
    EXPECT_EQ(c.state.objects.fragment_program, program.value) << "the default program has its id now";
}

TEST_F(AssemblyPrograms, TheStampTellsOfEachChange) {
    load(AssemblyStage::fragment);
    gl().Enable(c, kFragment);
    uses({});
    const UseStamp before = use_stamp(c);
    gl().ProgramLocalParameter4fARB(c, kFragment, 1, 1, 2, 3, 4);
    const UseStamp after = use_stamp(c);
    EXPECT_NE(before, after);
    gl().ProgramLocalParameter4fARB(c, kFragment, 1, 1, 2, 3, 4);
    EXPECT_EQ(use_stamp(c), after) << "an equal value is no change";
}

TEST_F(AssemblyPrograms, MatricesHaveStacksOfTheirOwn) {
    gl().MatrixMode(c, GL_MATRIX0_ARB + 3);
    gl().Translatef(c, 2, 0, 0);
    gl().PushMatrix(c);
    gl().LoadIdentity(c);
    GLint depth = 0;
    std::array<GLfloat, 16> matrix{};
    gl().GetIntegerv(c, GL_CURRENT_MATRIX_STACK_DEPTH_ARB, &depth);
    EXPECT_EQ(depth, 2);
    gl().PopMatrix(c);
    gl().GetFloatv(c, GL_CURRENT_MATRIX_ARB, matrix.data());
    EXPECT_EQ(matrix[12], 2);
    gl().GetFloatv(c, GL_TRANSPOSE_CURRENT_MATRIX_ARB, matrix.data());
    EXPECT_EQ(matrix[3], 2);
    EXPECT_EQ(c.state.program_matrices.program_matrix[3][12], 2);
    for (int i = 0; i < 3; ++i) gl().PushMatrix(c);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
    gl().PushMatrix(c);
    EXPECT_EQ(error(), GLenum{GL_STACK_OVERFLOW});
    gl().MatrixMode(c, GL_MATRIX0_ARB + 8);
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(AssemblyPrograms, DisplayListsHoldBindingsAndParameters) {
    gl().NewList(c, 1, GL_COMPILE);
    gl().BindProgramARB(c, kVertex, 6);
    gl().ProgramEnvParameter4fARB(c, kVertex, 0, 1, 0, 0, 0);
    const GLfloat two[] = {2, 0, 0, 0};
    gl().ProgramLocalParameters4fvEXT(c, kVertex, 0, 1, two);
    gl().EndList(c);
    EXPECT_EQ(value(kVertex, GL_PROGRAM_BINDING_ARB), 0);
    gl().CallList(c, 1);
    EXPECT_EQ(value(kVertex, GL_PROGRAM_BINDING_ARB), 6);
    EXPECT_EQ(environment(kVertex, 0)[0], 1);
    EXPECT_EQ(local(kVertex, 0)[0], 2);
}

TEST_F(AssemblyPrograms, AttributesSaveTheSwitchesOnly) {
    gl().PushAttrib(c, GL_ENABLE_BIT);
    gl().Enable(c, kVertex);
    gl().BindProgramARB(c, kVertex, 6);
    gl().PopAttrib(c);
    EXPECT_FALSE(gl().IsEnabled(c, kVertex));
    EXPECT_EQ(value(kVertex, GL_PROGRAM_BINDING_ARB), 6);
}

TEST(AssemblyProgramsOfOthers, CoreProfilesAndOpenGlEsHaveNone) {
    for (const ContextProfile& profile : {ContextProfile{.core = true}, ContextProfile{.es = 11}}) {
        Context c(std::make_shared<ShareGroup>(), profile);
        c.table->Enable(c, kVertex);
        EXPECT_EQ(c.take_error(), GLenum{GL_INVALID_ENUM});
        GLint position = -7;
        c.table->GetIntegerv(c, GL_PROGRAM_ERROR_POSITION_ARB, &position);
        EXPECT_EQ(c.take_error(), GLenum{GL_INVALID_ENUM});
        c.table->BindProgramARB(c, kVertex, 1);
        EXPECT_EQ(c.take_error(), GLenum{GL_INVALID_OPERATION});
    }
}

}  // namespace
}  // namespace wall::client
