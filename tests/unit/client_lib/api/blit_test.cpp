// SPDX-License-Identifier: MIT
// What glBlitFramebuffer refuses (OpenGL 4.6, 18.3.1); no node is asked.
#include <utility>

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

class ABlit : public ContextTest {
protected:
    GLuint framebuffer(GLenum attachment, GLenum format, GLsizei samples) {
        GLuint name = 0, image = 0;
        gl().GenRenderbuffers(c, 1, &image);
        gl().BindRenderbuffer(c, GL_RENDERBUFFER, image);
        gl().RenderbufferStorageMultisample(c, GL_RENDERBUFFER, samples, format, 100, 100);
        gl().GenFramebuffers(c, 1, &name);
        gl().BindFramebuffer(c, GL_FRAMEBUFFER, name);
        gl().FramebufferRenderbuffer(c, GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, image);
        return name;
    }
    /// Of 10x10 pixels. Of nothing where it is allowed: no node is there.
    GLenum blit(GLuint from, GLuint to, GLint width, GLint height, GLbitfield mask = GL_COLOR_BUFFER_BIT) {
        gl().BindFramebuffer(c, GL_READ_FRAMEBUFFER, from);
        gl().BindFramebuffer(c, GL_DRAW_FRAMEBUFFER, to);
        gl().BlitFramebuffer(c, 0, 0, 10, height, 0, 0, width, height, mask, GL_NEAREST);
        return error();
    }
    std::shared_ptr<ClientSurface> several = window_of(1, 4), eight = window_of(2, 8), one = window_of(3, 0);
};

TEST_F(ABlit, ScalesNoSamples) {
    c.bind_surfaces(several, several);
    const GLuint pixels = framebuffer(GL_COLOR_ATTACHMENT0, GL_RGBA8, 0),
                 samples = framebuffer(GL_COLOR_ATTACHMENT0, GL_RGBA8, 4);
    for (const auto& [from, to] : {std::pair{0u, pixels}, {pixels, 0u}, {0u, samples}, {samples, 0u}, {0u, 0u}}) {
        EXPECT_EQ(blit(from, to, 5, 10), GLenum{GL_INVALID_OPERATION}) << from << " to " << to;
        EXPECT_EQ(blit(from, to, 10, 0), GLenum{GL_NO_ERROR}) << from << " to " << to;
    }
    c.bind_surfaces(one, one);
    EXPECT_EQ(blit(0, pixels, 5, 0), GLenum{GL_NO_ERROR});
    EXPECT_EQ(blit(0, samples, 5, 10), GLenum{GL_INVALID_OPERATION});
}

TEST_F(ABlit, HasAsManySamplesOnBothSides) {
    c.bind_surfaces(several, eight);
    const GLuint samples = framebuffer(GL_COLOR_ATTACHMENT0, GL_RGBA8, 4);
    EXPECT_EQ(blit(0, 0, 10, 10), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(blit(0, samples, 10, 10), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(blit(samples, 0, 10, 0), GLenum{GL_NO_ERROR});
}

TEST_F(ABlit, CopiesDepthsOfOneFormat) {
    c.bind_surfaces(one, one);
    const GLbitfield depth = GL_DEPTH_BUFFER_BIT, stencil = GL_STENCIL_BUFFER_BIT;
    const GLuint whole = framebuffer(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, 0),
                 real = framebuffer(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT32F, 0),
                 both = framebuffer(GL_DEPTH_STENCIL_ATTACHMENT, GL_DEPTH32F_STENCIL8, 0);
    for (const GLuint other : {real, both}) {
        EXPECT_EQ(blit(0, other, 10, 10, depth), GLenum{GL_INVALID_OPERATION});
        EXPECT_EQ(blit(other, 0, 10, 10, depth), GLenum{GL_INVALID_OPERATION});
        EXPECT_EQ(blit(whole, other, 10, 10, depth), GLenum{GL_INVALID_OPERATION});
    }
    EXPECT_EQ(blit(0, whole, 10, 0, depth), GLenum{GL_NO_ERROR});
    EXPECT_EQ(blit(0, both, 10, 10, stencil), GLenum{GL_INVALID_OPERATION});
    EXPECT_EQ(blit(0, whole, 10, 10, stencil), GLenum{GL_NO_ERROR}) << "it has none, so nothing is done";
}

}  // namespace
}  // namespace wall::client
