// SPDX-License-Identifier: MIT
// Framebuffer objects on the wire: what was encoded comes back, and what no OpenGL command can say is refused.
#include "common/glstate/framebuffer.h"

#include <gtest/gtest.h>

namespace wall::glstate {
namespace {

FramebufferDefinition some_framebuffer() {
    FramebufferDefinition out;
    out.draw_buffers = {GL_COLOR_ATTACHMENT1, GL_NONE, GL_COLOR_ATTACHMENT0};
    out.read_buffer = GL_COLOR_ATTACHMENT1;
    out.defaults = {64, 32, 3, 4, 1};
    out.attachments = {{GL_COLOR_ATTACHMENT0, ClientName(7), GL_TEXTURE_2D, 3, 0},
                       {GL_COLOR_ATTACHMENT1, ClientName(8), GL_TEXTURE_3D, 0, 5},
                       {GL_DEPTH_ATTACHMENT, ClientName(9), GL_RENDERBUFFER, 0, 0},
                       {GL_STENCIL_ATTACHMENT, ClientName(9), GL_RENDERBUFFER, 0, 0}};
    return out;
}

TEST(Framebuffer, ComesBackAsItWas) {
    const auto bytes = encode(some_framebuffer());
    const auto out = decode_framebuffer(bytes);
    ASSERT_TRUE(out);
    EXPECT_EQ(*out, some_framebuffer());
    EXPECT_TRUE(decode_framebuffer(encode({})));
    for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(decode_framebuffer(std::span(bytes).first(n))) << n;
    auto longer = bytes;
    longer.resize(bytes.size() + sizeof(FramebufferAttachment));
    EXPECT_FALSE(decode_framebuffer(longer));
}

TEST(Framebuffer, RefusesWhatNoCommandCanSay) {
    const auto refused = [](auto&& change) {
        auto definition = some_framebuffer();
        change(definition);
        return !decode_framebuffer(encode(definition));
    };
    EXPECT_TRUE(refused([](auto& f) { f.draw_buffers[3] = GL_BACK; }));
    EXPECT_TRUE(refused([](auto& f) { f.read_buffer = GL_DEPTH_ATTACHMENT; }));
    EXPECT_TRUE(refused([](auto& f) { f.attachments[0].point = GL_COLOR_ATTACHMENT0 + kColorAttachments; }));
    EXPECT_TRUE(refused([](auto& f) { f.attachments[0].point = GL_COLOR_ATTACHMENT1; })) << "twice";
    EXPECT_TRUE(refused([](auto& f) { f.attachments[0].object = {}; }));
    EXPECT_TRUE(refused([](auto& f) { f.attachments[0].target = GL_PROXY_TEXTURE_2D; }));
    EXPECT_TRUE(refused([](auto& f) { f.attachments[0].target = GL_TEXTURE_CUBE_MAP; })) << "a face has the image";
    EXPECT_TRUE(refused([](auto& f) { f.attachments[0].level = -1; }));
    EXPECT_TRUE(refused([](auto& f) { f.attachments[1].layer = -2; }));
    EXPECT_TRUE(refused([](auto& f) { f.attachments[2].level = 1; })) << "of a renderbuffer";
    EXPECT_TRUE(refused([](auto& f) { f.defaults.width = kMostDefaultSize + 1; }));
    EXPECT_TRUE(refused([](auto& f) { f.defaults.samples = kMostDefaultSamples + 1; }));
    EXPECT_TRUE(refused([](auto& f) { f.defaults.fixed_places = 2; }));
    EXPECT_FALSE(refused([](auto&) {}));
}

TEST(Framebuffer, PlacesAndPointsAreTheSame) {
    for (unsigned place = 0; place < kAttachmentPoints; ++place)
        EXPECT_EQ(attachment_place(attachment_point(place)), place);
    EXPECT_FALSE(attachment_place(GL_DEPTH_STENCIL_ATTACHMENT));
    EXPECT_FALSE(attachment_place(GL_NONE));
    EXPECT_FALSE(attachment_place(GL_BACK));
}

}  // namespace
}  // namespace wall::glstate
