// SPDX-License-Identifier: MIT
// Framebuffer objects as the application sees them, and what becomes of the images that are drawn to.
#include "client_lib/objects/framebuffer.h"

#include <gtest/gtest.h>

#include "common/glapi/decoder.h"

namespace wall::client {
namespace {

using glstate::kColorAttachments;

std::shared_ptr<Texture> texture(GLint internal_format, GLenum format = GL_RGBA, std::int32_t size = 8) {
    auto out = std::make_shared<Texture>(next_object_id(), 1, glapi::TextureTarget::t2d);
    TextureLevel& level = out->level_at(0, 0);
    level.internal_format = internal_format;
    level.width = level.height = size;
    level.depth = 1;
    level.format = format;
    level.type = GL_UNSIGNED_BYTE;
    level.stamp = next_stamp();
    return out;
}

Attachment of(std::shared_ptr<Texture> image) { return {.texture = std::move(image), .target = GL_TEXTURE_2D}; }

Attachment renderbuffer(GLenum internal_format, std::uint32_t samples = 0, std::uint32_t size = 8) {
    auto out = std::make_shared<Renderbuffer>(1);
    out->define(samples, internal_format, size, size);
    return {.renderbuffer = std::move(out)};
}

/// Names of the commands in a buffer.
std::vector<std::string> commands(const wire::PackBuffer& buffer) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < buffer.commands(); ++i)
        names.emplace_back(glapi::kOpNames[std::to_integer<std::size_t>(buffer.opcode_at(i))]);
    return names;
}

TEST(AFramebuffer, IsCompleteWithOneImageThatCanBeDrawnTo) {
    Framebuffer f(1);
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT});
    f.attach(0, of(texture(GL_RGBA8)));
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_COMPLETE});
    f.attach(0, {});
    f.attach(kColorAttachments, renderbuffer(GL_DEPTH_COMPONENT24));
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_COMPLETE}) << "depth alone";
}

TEST(AFramebuffer, IsNotCompleteWithAnImageThatCannot) {
    Framebuffer f(1);
    f.attach(0, of(texture(GL_COMPRESSED_RGB_S3TC_DXT1_EXT)));
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT});
    f.attach(0, of(texture(GL_DEPTH_COMPONENT24)));
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT}) << "depth as a colour";
    f.attach(0, {.texture = texture(GL_RGBA8), .target = GL_TEXTURE_2D, .level = 3});
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT}) << "no such level";
    f.attach(0, {.texture = texture(GL_RGBA8), .target = GL_TEXTURE_2D, .layer = 1});
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT}) << "no such layer";
    f.attach(0, renderbuffer(GL_RGBA8, 0, 0));
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT}) << "no storage";
}

TEST(AFramebuffer, HasTheSameSamplesEverywhere) {
    Framebuffer f(1);
    f.attach(0, renderbuffer(GL_RGBA8, 4));
    f.attach(1, renderbuffer(GL_RGBA8, 0));
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE});
    f.attach(1, renderbuffer(GL_RGB8, 4));
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_COMPLETE});
    EXPECT_EQ(f.samples(), 4u);
}

TEST(AFramebuffer, HasDepthAndStencilInOneImage) {
    Framebuffer f(1);
    f.attach(kColorAttachments, renderbuffer(GL_DEPTH24_STENCIL8));
    f.attach(kColorAttachments + 1, renderbuffer(GL_DEPTH24_STENCIL8));
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_UNSUPPORTED});
    f.attach(kColorAttachments + 1, f.at(kColorAttachments));
    EXPECT_EQ(f.status(), GLenum{GL_FRAMEBUFFER_COMPLETE});
}

TEST(AFramebuffer, IsAsLargeAsItsSmallestImage) {
    Framebuffer f(1);
    EXPECT_EQ(f.width(), 0u);
    f.attach(0, of(texture(GL_RGBA8, GL_RGBA, 16)));
    f.attach(kColorAttachments, renderbuffer(GL_DEPTH_COMPONENT24, 0, 12));
    EXPECT_EQ(f.width(), 12u);
    EXPECT_EQ(f.height(), 12u);
}

TEST(AFramebuffer, IsToldToNodesAsItIs) {
    Framebuffer f(1);
    const auto before = f.latest();
    f.attach(0, of(texture(GL_RGBA8)));
    EXPECT_GT(f.latest(), before);
    const auto attached = f.latest();
    f.attach(0, Attachment(f.at(0)));
    EXPECT_EQ(f.latest(), attached) << "nothing has changed";
    wire::PackBuffer buffer;
    f.pack_changes(0, buffer, no_limit);
    EXPECT_EQ(commands(buffer), std::vector<std::string>{"Framebuffer"});
}

class DrawnImage : public testing::Test {
protected:
    void SetUp() override {
        image->faces[0][0].content = LevelContent::stored;
        image->faces[0][0].data_format = GL_RGBA;
        image->faces[0][0].data_type = GL_UNSIGNED_BYTE;
        image->faces[0][0].pixels.resize(8 * 8 * 4);
        image->stamp = next_stamp();
        f.attach(0, of(image));
    }
    std::vector<std::string> sent(std::uint64_t known) const {
        wire::PackBuffer buffer;
        image->pack_changes(known, buffer, no_limit);
        return commands(buffer);
    }
    /// As TexSubImage notes it.
    void change(std::int32_t x) {
        TextureLevel& level = image->faces[0][0];
        level.pixels.resize(8 * 8 * 4);
        level.data_format = GL_RGBA, level.data_type = GL_UNSIGNED_BYTE;
        level.note_change({x, 0, 0, 1, 1, 1, next_stamp()});
        image->stamp = next_stamp();
    }
    std::shared_ptr<Texture> image = texture(GL_RGBA8);
    Framebuffer f{1};
};

TEST_F(DrawnImage, IsNotTheClientsAnyMore) {
    EXPECT_FALSE(image->is_drawn());
    f.note_drawn();
    EXPECT_TRUE(image->is_drawn());
    EXPECT_TRUE(image->faces[0][0].pixels.empty());
    EXPECT_FALSE(image->worth_asking());
}

TEST_F(DrawnImage, IsSentNothingOfButWhatChangedSince) {
    f.note_drawn();
    const auto known = image->latest();
    EXPECT_TRUE(sent(known).empty());
    change(3);
    EXPECT_EQ(sent(known), std::vector<std::string>{"TexSubImage"});
    for (int i = 0; i < 40; ++i) change(i % 8);
    EXPECT_EQ(sent(known).size(), 8u) << "what lies between the parts is not the client's";
    f.note_drawn();
    EXPECT_TRUE(sent(known).empty());
}

TEST_F(DrawnImage, GoesFromNodeToNode) {
    f.note_drawn();
    EXPECT_EQ(sent(0), std::vector<std::string>{"TexImage"});
    wire::PackBuffer buffer;
    unsigned asked = 0;
    const auto ask = [&](const auto& pack, const ImageRows& rows) -> std::optional<std::vector<std::byte>> {
        EXPECT_EQ(rows.count, 8);
        EXPECT_EQ(rows.width, 8);
        wire::PackBuffer question;
        pack(question, RequestId(1));
        EXPECT_EQ(commands(question), std::vector<std::string>{"TexRead"});
        ++asked;
        return std::vector<std::byte>(8 * 8 * 4);
    };
    image->pack_drawn(ask, buffer, no_limit);
    EXPECT_EQ(asked, 1u);
    EXPECT_EQ(commands(buffer), std::vector<std::string>{"TexSubImage"});
}

TEST_F(DrawnImage, OfANodeThatDoesNotAnswerIsLeftOut) {
    f.note_drawn();
    wire::PackBuffer buffer;
    image->pack_drawn([](const auto&, const ImageRows&) { return std::nullopt; }, buffer, no_limit);
    EXPECT_EQ(buffer.commands(), 0u);
}

TEST(ExactPixels, LoseNothing) {
    const auto of_format = [](GLint internal_format, GLenum format) {
        const auto image = texture(internal_format, format);
        const auto [f, t] = exact_pixels(image->faces[0][0]);
        return std::pair{f, t};
    };
    EXPECT_EQ(of_format(GL_RGBA8, GL_RGBA), (std::pair<GLenum, GLenum>{GL_RGBA, GL_UNSIGNED_BYTE}));
    EXPECT_EQ(of_format(GL_RGBA16, GL_RGBA), (std::pair<GLenum, GLenum>{GL_RGBA, GL_UNSIGNED_SHORT}));
    EXPECT_EQ(of_format(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT),
              (std::pair<GLenum, GLenum>{GL_DEPTH_COMPONENT, GL_UNSIGNED_INT}));
    EXPECT_EQ(of_format(GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL),
              (std::pair<GLenum, GLenum>{GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8}));
}

}  // namespace
}  // namespace wall::client
