// SPDX-License-Identifier: MIT
// What OpenGL 3 added to single buffers, textures and queries, in a compatibility context: buffers cleared one by one,
// samplers, conditional rendering, counts that no number of tiles may change, fences.
#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

void box(GLfloat x, GLfloat y, GLfloat width, GLfloat height, GLfloat z) {
    glBegin(GL_QUADS);
    glTexCoord2f(-1, -1), glVertex3f(x, y, z);
    glTexCoord2f(3, -1), glVertex3f(x + width, y, z);
    glTexCoord2f(3, 3), glVertex3f(x + width, y + height, z);
    glTexCoord2f(-1, 3), glVertex3f(x, y + height, z);
    glEnd();
}

}  // namespace

SCENE(cleared_buffers, 2) {
    const GLfloat blue[] = {0.1f, 0.2f, 0.6f, 1}, orange[] = {0.9f, 0.5f, 0.1f, 1}, near = 0.3f;
    const GLint one = 1;
    glClearBufferfv(GL_COLOR, 0, blue);
    glClearBufferfi(GL_DEPTH_STENCIL, 0, 1, 0);
    glEnable(GL_SCISSOR_TEST);
    glScissor(90, 50, 180, 170);
    glClearBufferfv(GL_COLOR, 0, orange);
    glClearBufferfv(GL_DEPTH, 0, &near);
    glScissor(150, 20, 60, 260);
    glClearBufferiv(GL_STENCIL, 0, &one);
    glDisable(GL_SCISSOR_TEST);
    pixel_view(canvas);
    glEnable(GL_DEPTH_TEST);
    glColorMaski(0, GL_TRUE, frame == 0, GL_TRUE, GL_TRUE);
    glColor3f(0.2f, 0.9f, 0.4f);
    box(20, 100, 360, 40, 0);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_EQUAL, 1, 1);
    glDisable(GL_DEPTH_TEST);
    glColor3f(1, 1, 1);
    box(0, 200, 400, 30, 0);
    glDisable(GL_STENCIL_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glClearBufferfv(GL_FOG, 0, blue);
    say_error("no such buffer");
    glClearBufferfv(GL_COLOR, 8, blue);
    say_error("no such draw buffer");
    glClearBufferiv(GL_DEPTH, 0, &one);
    say_error("not by such values");
}

SCENE(samplers, 2) {
    clear();
    pixel_view(canvas);
    const GLubyte texels[] = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 0, 255};
    GLuint texture = 0, made[3] = {};
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 2, 2, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    glEnable(GL_TEXTURE_2D);
    glGenSamplers(3, made);
    const GLint wraps[] = {GL_CLAMP_TO_EDGE, GL_MIRRORED_REPEAT, GL_CLAMP_TO_BORDER};
    const GLfloat border[] = {1, 0.5f, 0, 1};
    for (int i = 0; i < 3; ++i) {
        glSamplerParameteri(made[i], GL_TEXTURE_MIN_FILTER, i == frame ? GL_LINEAR : GL_NEAREST);
        glSamplerParameteri(made[i], GL_TEXTURE_MAG_FILTER, i == frame ? GL_LINEAR : GL_NEAREST);
        glSamplerParameteri(made[i], GL_TEXTURE_WRAP_S, wraps[i]);
        glSamplerParameteri(made[i], GL_TEXTURE_WRAP_T, wraps[i]);
        glSamplerParameterfv(made[i], GL_TEXTURE_BORDER_COLOR, border);
        glBindSampler(0, made[i]);
        box(10 + 130 * static_cast<GLfloat>(i), 20, 120, 120, 0);
    }
    glBindSampler(0, 0);
    box(10, 160, 120, 120, 0);
    GLint wrap = 0, bound = 0;
    glBindSampler(0, made[2]);
    glGetSamplerParameteriv(made[2], GL_TEXTURE_WRAP_S, &wrap);
    glDeleteSamplers(3, made);
    glGetIntegerv(GL_SAMPLER_BINDING, &bound);
    box(140, 160, 120, 120, 0);
    say("wrap %04x, bound %d, sampler %d", static_cast<unsigned>(wrap), bound, glIsSampler(made[0]));
    glDisable(GL_TEXTURE_2D);
    glDeleteTextures(1, &texture);
    say_error("samplers");
}

// All tiles decide alike, although most of them see no sample of the smaller box. (What that one decides is drawn over:
// the references of walls are made in parts, and each of those decides by what it sees.)
SCENE(conditional, 2) {
    clear();
    glClear(GL_DEPTH_BUFFER_BIT);
    pixel_view(canvas);
    glEnable(GL_DEPTH_TEST);
    const auto count = [&](GLuint query, GLfloat x, GLfloat y, GLfloat width, GLfloat height) {
        const GLboolean off = GL_FALSE, on = GL_TRUE;
        glColorMask(off, off, off, off), glDepthMask(off);
        glBeginQuery(GL_ANY_SAMPLES_PASSED, query);
        box(x, y, width, height, frame == 0 ? -0.7f : 0.7f);  // hidden in one of the frames
        glEndQuery(GL_ANY_SAMPLES_PASSED);
        glColorMask(on, on, on, on), glDepthMask(on);
    };
    glColor3f(0.3f, 0.3f, 0.7f);
    box(0, 0, 400, 300, 0);
    glDepthFunc(GL_LEQUAL);
    GLuint queries[3] = {};
    glGenQueries(3, queries);
    count(queries[2], 50, 50, 20, 20);
    glBeginConditionalRender(queries[2], GL_QUERY_WAIT);
    glColor3f(1, 0, 0);
    box(300, 200, 40, 40, 0);
    glEndConditionalRender();
    GLubyte pixel[4] = {};
    glReadPixels(310, 210, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
    say("far from the samples: red %d", pixel[0]);
    glColor3f(0.3f, 0.3f, 0.7f);
    box(300, 200, 40, 40, 0);
    glDeleteQueries(1, &queries[2]);
    glGenQueries(1, &queries[2]);
    count(queries[0], 0, 0, 400, 300);
    glBeginQuery(GL_PRIMITIVES_GENERATED, queries[1]);
    glBegin(GL_TRIANGLE_STRIP);
    for (int i = 0; i < 9; ++i) glVertex2f(20 + 40 * static_cast<GLfloat>(i), i % 2 ? 150.0f : 190.0f);
    glEnd();
    glEndQuery(GL_PRIMITIVES_GENERATED);
    glBeginConditionalRender(queries[0], GL_QUERY_WAIT);
    glColor3f(0.9f, 0.8f, 0.1f);
    box(120, 20, 260, 100, 0);
    glEndConditionalRender();
    glBeginConditionalRender(queries[0], GL_QUERY_WAIT_INVERTED);
    glColor3f(0.1f, 0.8f, 0.9f);
    box(20, 210, 360, 70, 0);
    glEndConditionalRender();
    GLuint passed = 9;
    GLuint64 primitives = 0;
    glGetQueryObjectuiv(queries[0], GL_QUERY_RESULT, &passed);
    glGetQueryObjectui64v(queries[1], GL_QUERY_RESULT, &primitives);
    say("passed %u, %u primitives", passed, static_cast<unsigned>(primitives));
    glQueryCounter(queries[2], GL_TIMESTAMP);
    GLuint64 then = 0;
    GLint64 now = 0;
    glGetQueryObjectui64v(queries[2], GL_QUERY_RESULT, &then);
    glGetInteger64v(GL_TIMESTAMP, &now);
    say("time goes on: %d", then != 0 && static_cast<GLint64>(then) <= now);
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    const GLenum waited = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 5000000000ull);
    GLint status = 0;
    glGetSynciv(fence, GL_SYNC_STATUS, 1, nullptr, &status);
    say("done %d, signaled %d", waited == GL_ALREADY_SIGNALED || waited == GL_CONDITION_SATISFIED,
        status == GL_SIGNALED);
    glDeleteSync(fence);
    glDeleteQueries(3, queries);
    glDepthFunc(GL_LESS);
    glDisable(GL_DEPTH_TEST);
    say_error("conditional");
}

}  // namespace golden
