// SPDX-License-Identifier: MIT
// Several samples a pixel of windows and of framebuffer objects, as far as no node is asked.
#include <array>

#include "client_lib/follow/surface.h"
#include "tests/unit/client_lib/context_fixture.h"

namespace wall::client {
namespace {

std::shared_ptr<ClientSurface> window_of(std::uint32_t id, std::uint8_t samples) {
    auto window =
        std::make_shared<ClientSurface>(SurfaceId(id), SurfaceOptions{.format = {.accum_bits = 0, .samples = samples}});
    window->layout.width = window->layout.height = 100;
    return window;
}

class Samples : public ContextTest {
protected:
    GLint get(GLenum name) {
        GLint value = -1;
        gl().GetIntegerv(c, name, &value);
        return value;
    }
    /// A framebuffer object that is bound to both.
    GLuint framebuffer(GLsizei samples) {
        GLuint name = 0, image = 0;
        gl().GenRenderbuffers(c, 1, &image);
        gl().BindRenderbuffer(c, GL_RENDERBUFFER, image);
        gl().RenderbufferStorageMultisample(c, GL_RENDERBUFFER, samples, GL_RGBA8, 100, 100);
        gl().GenFramebuffers(c, 1, &name);
        gl().BindFramebuffer(c, GL_FRAMEBUFFER, name);
        gl().FramebufferRenderbuffer(c, GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, image);
        return name;
    }
    std::shared_ptr<ClientSurface> several = window_of(1, 4), one = window_of(2, 0);
};

TEST_F(Samples, AreThoseOfTheWindowOrOfTheFramebufferObject) {
    c.bind_surfaces(one, one);
    EXPECT_EQ(get(GL_SAMPLES), 0);
    EXPECT_EQ(get(GL_SAMPLE_BUFFERS), 0);
    c.bind_surfaces(several, several);
    EXPECT_EQ(get(GL_SAMPLES), 4);
    EXPECT_EQ(get(GL_SAMPLE_BUFFERS), 1);
    EXPECT_EQ(gl().IsEnabled(c, GL_MULTISAMPLE), GL_TRUE);
    GLint value = -1;
    gl().GetFramebufferParameteriv(c, GL_DRAW_FRAMEBUFFER, GL_SAMPLES, &value);
    EXPECT_EQ(value, 4);
    framebuffer(0);
    EXPECT_EQ(get(GL_SAMPLES), 0);
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

TEST_F(Samples, HavePlacesUpToTheirNumber) {
    std::array<GLfloat, 2> place{};
    c.bind_surfaces(one, one);
    gl().GetMultisamplefv(c, GL_SAMPLE_POSITION, 0, place.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    c.bind_surfaces(several, several);
    gl().GetMultisamplefv(c, GL_SAMPLE_POSITION, 4, place.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_VALUE});
    gl().GetMultisamplefv(c, GL_SAMPLES, 0, place.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_ENUM});
}

TEST_F(Samples, OfAWindowCanBeReadAsPixels) {
    c.bind_surfaces(several, several);
    framebuffer(4);
    std::array<GLubyte, 4> pixel{};
    gl().ReadPixels(c, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    EXPECT_EQ(error(), GLenum{GL_INVALID_OPERATION});
    gl().BindFramebuffer(c, GL_FRAMEBUFFER, 0);
    gl().ReadPixels(c, 0, 0, 0, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
    EXPECT_EQ(error(), GLenum{GL_NO_ERROR});
}

}  // namespace
}  // namespace wall::client
