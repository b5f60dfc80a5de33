// SPDX-License-Identifier: MIT
// Mesa's own functions, for those that stand in their place.
#pragma once

#define GL_GLEXT_PROTOTYPES 1
#include <GL/gl.h>
#include <GL/glext.h>

namespace golden::moved {

/// A function of Mesa, as whatever type it is assigned to.
struct Found {
    void* function;
    template <class Function>
    operator Function*() const {  // NOLINT: that is what it is for
        return reinterpret_cast<Function*>(function);
    }
};
Found find(const char* name);

struct Mesa {
    decltype(&glViewport) Viewport = find("glViewport");
    decltype(&glScissor) Scissor = find("glScissor");
    void (*DrawTexfOES)(GLfloat, GLfloat, GLfloat, GLfloat, GLfloat) = find("glDrawTexfOES");
    decltype(&glWindowPos3d) WindowPos3d = find("glWindowPos3d");
    decltype(&glBindFramebuffer) BindFramebuffer = find("glBindFramebuffer");
    decltype(&glBlitFramebuffer) BlitFramebuffer = find("glBlitFramebuffer");
    decltype(&glGenFramebuffers) GenFramebuffers = find("glGenFramebuffers");
    decltype(&glDeleteFramebuffers) DeleteFramebuffers = find("glDeleteFramebuffers");
    decltype(&glFramebufferRenderbuffer) FramebufferRenderbuffer = find("glFramebufferRenderbuffer");
    decltype(&glGenRenderbuffers) GenRenderbuffers = find("glGenRenderbuffers");
    decltype(&glDeleteRenderbuffers) DeleteRenderbuffers = find("glDeleteRenderbuffers");
    decltype(&glBindRenderbuffer) BindRenderbuffer = find("glBindRenderbuffer");
    decltype(&glRenderbufferStorage) RenderbufferStorage = find("glRenderbufferStorage");
    decltype(&glIsEnabled) IsEnabled = find("glIsEnabled");
    decltype(&glEnable) Enable = find("glEnable");
    decltype(&glDisable) Disable = find("glDisable");
    decltype(&glCopyTexImage1D) CopyTexImage1D = find("glCopyTexImage1D");
    decltype(&glCopyTexImage2D) CopyTexImage2D = find("glCopyTexImage2D");
    decltype(&glCopyTexSubImage1D) CopyTexSubImage1D = find("glCopyTexSubImage1D");
    decltype(&glCopyTexSubImage2D) CopyTexSubImage2D = find("glCopyTexSubImage2D");
    decltype(&glPolygonStipple) PolygonStipple = find("glPolygonStipple");
    decltype(&glGetIntegerv) GetIntegerv = find("glGetIntegerv");
    decltype(&glGetFloatv) GetFloatv = find("glGetFloatv");
    decltype(&glGetDoublev) GetDoublev = find("glGetDoublev");
    decltype(&glShaderSource) ShaderSource = find("glShaderSource");
    decltype(&glProgramStringARB) ProgramString = find("glProgramStringARB");
    decltype(&glProgramEnvParameter4fARB) ProgramEnvParameter4f = find("glProgramEnvParameter4fARB");
    decltype(&glUseProgram) UseProgram = find("glUseProgram");
    decltype(&glLinkProgram) LinkProgram = find("glLinkProgram");
    decltype(&glGetUniformLocation) GetUniformLocation = find("glGetUniformLocation");
    decltype(&glUniform4f) Uniform4f = find("glUniform4f");
    decltype(&glGetString) GetString = find("glGetString");
    decltype(&glReadPixels) ReadPixels = find("glReadPixels");
    decltype(&glDrawPixels) DrawPixels = find("glDrawPixels");
    decltype(&glBitmap) Bitmap = find("glBitmap");
    decltype(&glTexImage1D) TexImage1D = find("glTexImage1D");
    decltype(&glTexImage2D) TexImage2D = find("glTexImage2D");
    decltype(&glTexSubImage1D) TexSubImage1D = find("glTexSubImage1D");
    decltype(&glTexSubImage2D) TexSubImage2D = find("glTexSubImage2D");
    decltype(&glPixelStorei) PixelStorei = find("glPixelStorei");
    decltype(&glPixelTransferf) PixelTransferf = find("glPixelTransferf");
    decltype(&glPushClientAttrib) PushClientAttrib = find("glPushClientAttrib");
    decltype(&glPopClientAttrib) PopClientAttrib = find("glPopClientAttrib");
};
const Mesa& mesa();

/// Whether the program draws to (reads from) its window, and not to a framebuffer object, where nothing is moved.
bool draws_to_window();
bool reads_from_window();

/// Whether the context is of OpenGL ES 1.1.
bool is_es1();

/// The value of a state variable, as Mesa has it.
int integer(GLenum name);

}  // namespace golden::moved
