// SPDX-License-Identifier: MIT
// Advanced equations of blending: what takes them, and what may be drawn with them.
#include <vector>

#include "client_lib/context/program_use.h"
#include "client_lib/objects/program.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

class BlendEquations : public ContextTest {
protected:
    GLint value(GLenum word) {
        GLint out = -1;
        gl().GetIntegerv(c, word, &out);
        return out;
    }
    /// As if a node had linked a program of that fragment shader.
    void use(const char* source) {
        const GLuint name = gl().CreateProgram(c);
        const auto program = std::static_pointer_cast<Program>(share->glsl_objects.find(name));
        glapi::ProgramDefinition definition;
        definition.shaders = {{GL_VERTEX_SHADER, true, ""}, {GL_FRAGMENT_SHADER, true, source}};
        glapi::ProgramReflection reflection;
        reflection.linked = true;
        program->executable = Executable::make(definition, reflection);
        program->linked = true;
        gl().UseProgram(c, name);
    }
    GLenum draw_error() {
        may_draw(c);
        return error();
    }
};

constexpr GLenum kNone = GL_NO_ERROR, kEnum = GL_INVALID_ENUM, kValue = GL_INVALID_VALUE,
                 kOperation = GL_INVALID_OPERATION;

TEST_F(BlendEquations, AreAdvancedForColoursAndAlphaTogether) {
    gl().BlendEquation(c, GL_MULTIPLY_KHR);
    EXPECT_EQ(error(), kNone);
    EXPECT_EQ(value(GL_BLEND_EQUATION_RGB), GL_MULTIPLY_KHR);
    EXPECT_EQ(value(GL_BLEND_EQUATION_ALPHA), GL_MULTIPLY_KHR);
    gl().BlendEquationSeparate(c, GL_MULTIPLY_KHR, GL_MULTIPLY_KHR);
    EXPECT_EQ(error(), kEnum);
    gl().BlendEquationi(c, 1, GL_SCREEN_KHR);
    EXPECT_EQ(error(), kNone);
    GLint second = 0;
    gl().GetIntegeri_v(c, GL_BLEND_EQUATION_RGB, 1, &second);
    EXPECT_EQ(second, GL_SCREEN_KHR);
    EXPECT_EQ(value(GL_BLEND_EQUATION_RGB), GL_MULTIPLY_KHR);
    gl().BlendEquationi(c, 100, GL_SCREEN_KHR);
    EXPECT_EQ(error(), kValue);
    gl().BlendEquationSeparatei(c, 1, GL_SCREEN_KHR, GL_SCREEN_KHR);
    EXPECT_EQ(error(), kEnum);
    gl().BlendEquation(c, GL_RGBA);
    EXPECT_EQ(error(), kEnum);
    gl().BlendEquation(c, GL_MAX);
    EXPECT_EQ(error(), kNone);
    EXPECT_EQ(value(GL_BLEND_EQUATION_ALPHA), GL_MAX);
}

TEST_F(BlendEquations, WantAShaderThatSaysThatItGoesWithThem) {
    gl().BlendEquation(c, GL_MULTIPLY_KHR);
    EXPECT_EQ(draw_error(), kNone) << "nothing is blended";
    gl().Enable(c, GL_BLEND);
    EXPECT_EQ(draw_error(), kOperation) << "fixed function";
    use("layout(blend_support_screen) out;");
    EXPECT_EQ(draw_error(), kOperation);
    use("layout(blend_support_multiply) out;");
    EXPECT_EQ(draw_error(), kNone);
    gl().BlendEquation(c, GL_SCREEN_KHR);
    EXPECT_EQ(draw_error(), kOperation);
    gl().BlendEquation(c, GL_FUNC_ADD);
    EXPECT_EQ(draw_error(), kNone);
}

TEST_F(BlendEquations, AreOfDisplayLists) {
    const GLuint list = gl().GenLists(c, 1);
    gl().NewList(c, list, GL_COMPILE);
    gl().BlendEquation(c, GL_DARKEN_KHR);
    gl().EndList(c);
    EXPECT_EQ(value(GL_BLEND_EQUATION_RGB), GL_FUNC_ADD);
    gl().CallList(c, list);
    EXPECT_EQ(value(GL_BLEND_EQUATION_RGB), GL_DARKEN_KHR);
    EXPECT_EQ(error(), kNone);
}

TEST_F(BlendEquations, AreCoherentUnlessToldOtherwise) {
    EXPECT_TRUE(gl().IsEnabled(c, GL_BLEND_ADVANCED_COHERENT_KHR));
    gl().Disable(c, GL_BLEND_ADVANCED_COHERENT_KHR);
    EXPECT_FALSE(gl().IsEnabled(c, GL_BLEND_ADVANCED_COHERENT_KHR));
    EXPECT_EQ(error(), kNone);
}

}  // namespace
}  // namespace wall::client
