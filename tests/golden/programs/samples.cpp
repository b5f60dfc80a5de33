// SPDX-License-Identifier: MIT
// Windows whose pixels have several samples.
#include <array>
#include <cmath>
#include <utility>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

constexpr int kSamples = 4;

/// Turned a little with each frame, so that edges lie at all angles.
void fan(int frame, float size) {
    glBegin(GL_TRIANGLE_FAN);
    for (int i = 0; i < 12; ++i) {
        const float a = 0.55f * static_cast<float>(i) + 0.1f * static_cast<float>(frame);
        glColor4f(0.5f + 0.5f * std::cos(a), 0.3f, 0.5f + 0.5f * std::sin(2 * a), 0.1f * static_cast<float>(i));
        glVertex3f(size * std::cos(a), size * std::sin(a), 0.9f * std::sin(3 * a));
    }
    glEnd();
}

void lines_and_points() {
    for (const float width : {1.0f, 3.0f}) {
        glLineWidth(width);
        glPointSize(3 * width);
        glBegin(GL_LINE_STRIP);
        for (int i = 0; i < 30; ++i)
            glVertex2f(-0.9531f + 0.0647f * static_cast<float>(i), 0.8f * std::sin(static_cast<float>(i) * width));
        glEnd();
        glBegin(GL_POINTS);
        for (int i = 0; i < 30; ++i)
            glVertex2f(-0.93f + 0.063f * static_cast<float>(i), 0.9f * std::cos(static_cast<float>(i) * width));
        glEnd();
    }
}

GLuint linked(const char* fragment) {
    return linked_program("#version 130\nvoid main() { gl_Position = gl_Vertex; gl_FrontColor = gl_Color; }\n",
                          fragment, {});
}

void say_of_the_window() {
    for (const GLenum name : {GL_SAMPLE_BUFFERS, GL_SAMPLES, GL_MULTISAMPLE}) {
        GLint value = -1;
        glGetIntegerv(name, &value);
        say("0x%04x: %d", name, value);
    }
    for (GLuint i = 0; i <= kSamples; ++i) {
        std::array<GLfloat, 2> place{-1, -1};
        glGetMultisamplefv(GL_SAMPLE_POSITION, i, place.data());
        say("sample %u: %.5g %.5g", i, place[0], place[1]);
        say_error("glGetMultisamplefv");
    }
    for (const GLenum name : {GL_SAMPLES, GL_SAMPLE_BUFFERS}) {
        GLint value = -1;
        glGetFramebufferParameteriv(GL_DRAW_FRAMEBUFFER, name, &value);
        say("framebuffer 0x%04x: %d", name, value);
    }
}

GLuint samples_passed(void (*draw)()) {
    GLuint query = 0, count = 0;
    glGenQueries(1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    draw();
    glEndQuery(GL_SAMPLES_PASSED);
    glGetQueryObjectuiv(query, GL_QUERY_RESULT, &count);
    glDeleteQueries(1, &query);
    return count;
}

}  // namespace

SCENE(samples, 4, {.samples = kSamples}) {
    if (frame == 0) say_of_the_window();
    clear(0.1f, 0.2f, 0.3f);
    glEnable(GL_DEPTH_TEST);
    fan(frame, 0.9f);
    glColor3f(1, 1, 0.3f);
    lines_and_points();
    glRotatef(30, 0, 0, 1);
    fan(frame + 1, 0.7f);
    glDisable(GL_DEPTH_TEST);
}

SCENE(samples_off, 2, {.samples = kSamples}) {
    clear();
    for (const bool on : {true, false}) {
        cell_view(on, 2, 1);
        on ? glEnable(GL_MULTISAMPLE) : glDisable(GL_MULTISAMPLE);
        fan(frame, 0.9f);
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        for (const GLenum smooth : {GL_LINE_SMOOTH, GL_POLYGON_SMOOTH}) glEnable(smooth);
        glColor4f(0.2f, 1, 0.4f, 0.8f);
        lines_and_points();
        for (const GLenum smooth : {GL_LINE_SMOOTH, GL_POLYGON_SMOOTH}) glDisable(smooth);
        glDisable(GL_BLEND);
    }
    glEnable(GL_MULTISAMPLE);
}

SCENE(samples_covered, 3, {.samples = kSamples}) {
    clear(0.3f, 0.1f, 0.1f);
    for (int i = 0; i < 6; ++i) {
        cell_view(i, 3, 2);
        if (i == 1 || i == 2) glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
        if (i == 2) glEnable(GL_SAMPLE_ALPHA_TO_ONE);
        if (i == 3 || i == 4) glEnable(GL_SAMPLE_COVERAGE);
        glSampleCoverage(0.25f * static_cast<float>(frame + 1), i == 4);
        if (i == 5) glEnable(GL_SAMPLE_MASK);
        glSampleMaski(0, 0x9);
        fan(frame, 0.9f);
        for (const GLenum what :
             {GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_ALPHA_TO_ONE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK})
            glDisable(what);
    }
}

SCENE(samples_stencil_and_images, 3, {.samples = kSamples}) {
    clear(0.1f, 0.3f, 0.1f);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 1, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
    fan(frame, 0.8f);
    glStencilFunc(GL_EQUAL, 1, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glColor3f(0.9f, 0.9f, 0.9f);
    unit_square();
    glDisable(GL_STENCIL_TEST);
    pixel_view(canvas);
    const auto image = random_image(60 * 40 * 4);
    glRasterPos2f(101.3f, 77.6f);
    glDrawPixels(60, 40, GL_RGBA, GL_UNSIGNED_BYTE, image.data());
    glColor3f(0, 1, 1);
    for (int i = 0; i < 5; ++i) {
        glRasterPos2f(20.4f + 77 * static_cast<float>(i), 140.7f);
        glBitmap(32, 40, 0, 0, 0, 0, image.data());
    }
}

SCENE(samples_shaders, 3, {.samples = kSamples}) {
    static const std::array<GLuint, 4> programs = {
        linked("#version 130\n#extension GL_ARB_sample_shading : require\n"
               "void main() { gl_FragColor = vec4(gl_SamplePosition, 0.25 * float(gl_SampleID), 1); }\n"),
        linked("#version 130\n#extension GL_ARB_sample_shading : require\n"
               "void main() { gl_FragColor = gl_Color; gl_SampleMask[0] = gl_SampleID * 3; }\n"),
        linked("#version 130\n"
               "void main() { gl_FragColor = vec4(fract(gl_FragCoord.xy / 7.0), gl_FragCoord.z, 1); }\n"),
        linked("#version 130\ncentroid in vec4 unused;\n"
               "void main() { gl_FragColor = vec4(fract(0.03 * gl_FragCoord.xy), 0.5 + dFdx(gl_Color.r), 1); }\n")};
    clear(0.2f, 0.2f, 0.2f);
    for (int i = 0; i < 4; ++i) {
        glViewport(i % 2 * canvas.width / 2, i / 2 * canvas.height / 2, canvas.width / 2, canvas.height / 2);
        glUseProgram(programs[static_cast<std::size_t>(i)]);
        if (i == 2 && frame == 1) {
            glEnable(GL_SAMPLE_SHADING);
            glMinSampleShading(1);
        }
        fan(frame, 0.9f);
        glDisable(GL_SAMPLE_SHADING);
    }
    glUseProgram(0);
    glViewport(0, 0, canvas.width, canvas.height);
}

SCENE(samples_blits, 3, {.samples = kSamples}) {
    static std::array<GLuint, 2> framebuffers, renderbuffers;
    if (framebuffers[0] == 0) {
        glGenFramebuffers(2, framebuffers.data());
        glGenRenderbuffers(2, renderbuffers.data());
        for (int i = 0; i < 2; ++i) {
            glBindRenderbuffer(GL_RENDERBUFFER, renderbuffers[static_cast<std::size_t>(i)]);
            glRenderbufferStorageMultisample(GL_RENDERBUFFER, i * kSamples, GL_RGBA8, 120, 90);
            glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[static_cast<std::size_t>(i)]);
            glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                      renderbuffers[static_cast<std::size_t>(i)]);
        }
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    clear(0.1f, 0.1f, 0.4f);
    for (int i = 0; i < 2; ++i) {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffers[static_cast<std::size_t>(i)]);
        glViewport(0, 0, 120, 90);
        glClearColor(0.3f, 0, 0.3f, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        fan(frame, 0.9f);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        const int x = 140 * i + 13, y = 107;
        glBlitFramebuffer(0, 0, 120, 90, x, y, x + 120, y + 90, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        say_error("blit of the same size");
        glBlitFramebuffer(0, 0, 120, 90, x, 7, x + 60, 52, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        say_error("blit of another size");
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, canvas.width, canvas.height);
}

SCENE(samples_counted, 2, {.samples = kSamples}) {
    clear();
    glColor3f(1, 0.5f, 0);
    if (frame == 0) say("whole window: %u", samples_passed([] { unit_square(); }));
    else say("a triangle: %u", samples_passed([] { fan(0, 0.6f); }));
}

SCENE(samples_single_buffered, 3, {.double_buffered = false, .samples = kSamples, .read = GL_FRONT}) {
    clear(0.1f, 0, 0.2f);
    fan(frame, 0.9f);
    glFlush();
    glColor3f(1, 1, 0);
    lines_and_points();
}

SCENE(samples_egl, 3, {.egl = true, .samples = kSamples}) {
    clear(0.1f, 0.2f, 0.3f);
    fan(frame, 0.9f);
}

}  // namespace golden
