// SPDX-License-Identifier: MIT
// Texels that a node copies from image to image, and textures that are parts of one storage; what is refused.
#include <gmock/gmock.h>

#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/unit/tileserver/test_node.h"

namespace wall::tileserver::test {
namespace {

using ::testing::HasSubstr;

constexpr int kSize = 8;
constexpr geom::Rect kWindow{0, 0, kSize, kSize};
constexpr ClientName kArray(31), kView(32), kWords(33), kCube(34), kRenderbuffer(35);

class ImageCopyTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!node_.usable()) GTEST_SKIP() << "no driver";
        node_.node->tiles = {{0, kWindow}};
        session_.emplace(*node_.node, SessionId(1));
        session_->open_surface(kSize, kSize, kWindow);
    }
    /// Layers of one colour each: red is 16 times the layer.
    static void define_array(wire::PackBuffer& b) {
        std::vector<std::byte> texels(4 * kSize * kSize * 6);
        for (std::size_t i = 0; i < texels.size(); i += 4)
            texels[i] = static_cast<std::byte>(16 * (i / (4 * kSize * kSize))), texels[i + 3] = std::byte{255};
        pack::TexImage(b, kArray, GL_TEXTURE_2D_ARRAY, 0, GL_RGBA8, kSize, kSize, 6, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                       texels);
        pack::TexParameter(b, kArray, GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0, 0, 0, 0);
    }
    static void store_array(wire::PackBuffer& b) {
        pack::TexStorage(b, kArray, GL_TEXTURE_2D_ARRAY, 1, GL_RGBA8, kSize, kSize, 6, 0, 0);
    }
    static void define_words(wire::PackBuffer& b) {
        pack::TexImage(b, kWords, GL_TEXTURE_2D, 0, GL_R32UI, kSize, kSize, 1, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, {});
        pack::TexParameter(b, kWords, GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST, 0, 0, 0);
    }
    void run(const std::function<void(wire::PackBuffer&)>& commands) {
        Batch batch;
        commands(batch.buffer());
        session_->expect_run(batch);
    }
    void run_in_block(const std::function<void(wire::PackBuffer&)>& commands) {
        Batch batch;
        batch.block(1, commands);
        session_->expect_run(batch);
    }
    /// The texels of a slice.
    std::vector<std::uint32_t> texels(ClientName name, GLenum target, int slice, GLenum format, GLenum type) {
        constexpr RequestId kRequest(7);
        run([&](auto& b) { pack::TexRead(b, kRequest, name, target, 0, slice, 0, kSize, format, type); });
        const auto& bytes = session_->replies[kRequest];
        std::vector<std::uint32_t> out(bytes.size() / 4);
        std::memcpy(out.data(), bytes.data(), bytes.size());
        return out;
    }
    /// Why a stream is refused that has these commands behind an array with storage.
    std::string refusal(const std::function<void(wire::PackBuffer&)>& commands, bool in_block) {
        TestSession session(*node_.node, SessionId(2));
        session.open_surface(kSize, kSize, kWindow);
        Batch batch;
        define_array(batch.buffer());
        store_array(batch.buffer());
        define_words(batch.buffer());
        if (in_block) batch.block(1, commands);
        else commands(batch.buffer());
        const auto done = session.run(batch);
        return done ? "" : done.error().message;
    }

    TestNode node_;
    std::optional<TestSession> session_;
};

TEST_F(ImageCopyTest, TexelsGoOverAsTheyAreStored) {
    run(define_array);
    run(define_words);
    run_in_block([](auto& b) {
        pack::CopyImage(b, kArray, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 3, kWords, GL_TEXTURE_2D, 0, 2, 1, 0, 4, 4, 1);
    });
    const auto words = texels(kWords, GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT);
    ASSERT_EQ(words.size(), std::size_t{kSize * kSize});
    EXPECT_EQ(words[kSize + 2], 0xff000030u);
    EXPECT_EQ(words[4 * kSize + 5], 0xff000030u);
    EXPECT_EQ(words[4 * kSize + 6], 0u);
    EXPECT_EQ(session_->session.work.gl_errors, 0u);
}

TEST_F(ImageCopyTest, RenderbuffersAreImages) {
    run(define_array);
    run([](auto& b) { pack::Renderbuffer(b, kRenderbuffer, 0, GL_RGBA8, kSize, kSize); });
    run_in_block([](auto& b) {
        pack::CopyImage(b, kArray, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 2, kRenderbuffer, GL_RENDERBUFFER, 0, 0, 0, 0, kSize,
                        kSize, 1);
        pack::CopyImage(b, kRenderbuffer, GL_RENDERBUFFER, 0, 0, 0, 0, kArray, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 5, kSize,
                        kSize, 1);
    });
    EXPECT_EQ(texels(kArray, GL_TEXTURE_2D_ARRAY, 5, GL_RGBA, GL_UNSIGNED_BYTE)[3], 0xff000020u);
    EXPECT_EQ(session_->session.work.gl_errors, 0u);
}

TEST_F(ImageCopyTest, AViewShowsWhatItsOriginHas) {
    run(define_array);
    run(store_array);
    EXPECT_EQ(texels(kArray, GL_TEXTURE_2D_ARRAY, 4, GL_RGBA, GL_UNSIGNED_BYTE)[9], 0xff000040u)
        << "images are copied into the storage";
    run([](auto& b) { pack::TexView(b, kView, kArray, GL_TEXTURE_2D, GL_R32UI, 0, 1, 4, 1); });
    EXPECT_EQ(texels(kView, GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT)[9], 0xff000040u);
    const std::array<std::uint32_t, 1> word{0x01020304};
    run([&](auto& b) {
        pack::TexSubImage(b, kView, GL_TEXTURE_2D, 0, 1, 1, 0, 1, 1, 1, GL_RED_INTEGER, GL_UNSIGNED_INT,
                          std::as_bytes(std::span(word)));
        store_array(b);  // again, as for a node that may have lost it
        pack::TexView(b, kView, kArray, GL_TEXTURE_2D, GL_R32UI, 0, 1, 4, 1);
    });
    EXPECT_EQ(texels(kArray, GL_TEXTURE_2D_ARRAY, 4, GL_RGBA, GL_UNSIGNED_BYTE)[kSize + 1], word[0]);
    run([](auto& b) { pack::TexView(b, kCube, kArray, GL_TEXTURE_CUBE_MAP, GL_RGBA8, 0, 1, 0, 6); });
    EXPECT_EQ(texels(kCube, GL_TEXTURE_CUBE_MAP_NEGATIVE_Z, 0, GL_RGBA, GL_UNSIGNED_BYTE)[0], 0xff000050u);
    EXPECT_EQ(session_->session.work.gl_errors, 0u);
}

TEST_F(ImageCopyTest, ViewsAreCountedAsTexturesAre) {
    const auto before = node_.driver->gl().objects->textures;
    run(define_array);
    run(store_array);
    run([](auto& b) { pack::TexView(b, kView, kArray, GL_TEXTURE_2D, GL_R32UI, 0, 1, 4, 1); });
    EXPECT_EQ(node_.driver->gl().objects->textures, before + 2);
    run([](auto& b) {
        pack::ObjectDelete(b, kArray);
        pack::ObjectDelete(b, kView);
    });
    EXPECT_EQ(node_.driver->gl().objects->textures, before);
}

TEST_F(ImageCopyTest, AViewOutlivesItsOriginAndHasMipmaps) {
    run([](auto& b) {
        pack::TexStorage(b, kArray, GL_TEXTURE_2D_ARRAY, 3, GL_RGBA8, kSize, kSize, 6, 0, 0);
        pack::TexView(b, kView, kArray, GL_TEXTURE_2D, GL_RGBA8, 1, 2, 2, 1);
        const std::vector<std::byte> white(4 * 4 * 4, std::byte{255});
        pack::TexSubImage(b, kView, GL_TEXTURE_2D, 0, 0, 0, 0, 4, 4, 1, GL_RGBA, GL_UNSIGNED_BYTE, white);
    });
    run_in_block([](auto& b) { pack::ViewMipmaps(b, kView, GL_TEXTURE_2D, 0, 1); });
    run([](auto& b) { pack::ObjectDelete(b, kArray); });
    constexpr RequestId kRequest(8);
    run([&](auto& b) { pack::TexRead(b, kRequest, kView, GL_TEXTURE_2D, 1, 0, 0, 2, GL_RGBA, GL_UNSIGNED_BYTE); });
    EXPECT_EQ(session_->replies[kRequest], std::vector<std::byte>(2 * 2 * 4, std::byte{255}));
    EXPECT_EQ(session_->session.work.gl_errors, 0u);
}

TEST_F(ImageCopyTest, WhatACorrectClientDoesNotSendIsRefused) {
    const auto copy = [&](GLenum target, int level, int z, int width, int depth, ClientName to = kWords) {
        return refusal(
            [&](auto& b) {
                pack::CopyImage(b, kArray, target, level, 0, 0, z, to, GL_TEXTURE_2D, 0, 0, 0, 0, width, 1, depth);
            },
            true);
    };
    EXPECT_EQ(copy(GL_TEXTURE_2D_ARRAY, 0, 0, 4, 1), "");
    EXPECT_THAT(copy(GL_TEXTURE_2D, 0, 0, 4, 1), HasSubstr("no such texture"));
    EXPECT_THAT(copy(GL_TEXTURE_2D_ARRAY, 0, 0, 4, 1, ClientName(999)), HasSubstr("no such texture"));
    EXPECT_THAT(copy(GL_RENDERBUFFER, 0, 0, 4, 1), HasSubstr("no such renderbuffer"));
    EXPECT_THAT(copy(GL_TEXTURE_2D_ARRAY, 15, 0, 4, 1), HasSubstr("no such place"));
    EXPECT_THAT(copy(GL_TEXTURE_2D_ARRAY, 0, -1, 4, 1), HasSubstr("no such place"));
    EXPECT_THAT(copy(GL_TEXTURE_2D_ARRAY, 0, 0, 1 << 20, 1), HasSubstr("absurd size"));
    const auto view = [&](ClientName origin, GLenum target, unsigned first_level, unsigned levels, unsigned first_layer,
                          unsigned layers) {
        return refusal(
            [&](auto& b) {
                pack::TexView(b, kView, origin, target, GL_RGBA8, first_level, levels, first_layer, layers);
            },
            false);
    };
    EXPECT_EQ(view(kArray, GL_TEXTURE_2D, 0, 1, 5, 1), "");
    EXPECT_EQ(view(kWords, GL_TEXTURE_2D, 0, 1, 0, 1), "") << "no storage: the driver may have refused it";
    EXPECT_THAT(view(ClientName(999), GL_TEXTURE_2D, 0, 1, 0, 1), HasSubstr("no such texture"));
    EXPECT_THAT(view(kView, GL_TEXTURE_2D, 0, 1, 0, 1), HasSubstr("no such texture"));
    EXPECT_THAT(view(kArray, GL_TEXTURE_BUFFER, 0, 1, 0, 1), HasSubstr("no such target"));
    EXPECT_THAT(view(kArray, GL_TEXTURE_2D, 1, 1, 0, 1), HasSubstr("no such part"));
    EXPECT_THAT(view(kArray, GL_TEXTURE_2D, 0, 0, 0, 1), HasSubstr("no such part"));
    EXPECT_THAT(view(kArray, GL_TEXTURE_2D_ARRAY, 0, 1, 5, ~0u), HasSubstr("no such part"));
    const auto storage = [&](GLenum target, unsigned levels, int width, unsigned samples) {
        return refusal([&](auto& b) { pack::TexStorage(b, kView, target, levels, GL_RGBA8, width, 1, 1, samples, 0); },
                       false);
    };
    EXPECT_THAT(storage(GL_TEXTURE_2D, 16, 4, 0), HasSubstr("absurd size"));
    EXPECT_THAT(storage(GL_TEXTURE_2D, 1, 0, 0), HasSubstr("absurd size"));
    EXPECT_THAT(storage(GL_TEXTURE_2D, 1, 4, 4), HasSubstr("no such target"));
    EXPECT_THAT(storage(GL_TEXTURE_CUBE_MAP_POSITIVE_X, 1, 4, 0), HasSubstr("no such target"));
    EXPECT_EQ(storage(GL_TEXTURE_2D, 9, 4, 0), "") << "the driver refuses it";
}

TEST_F(ImageCopyTest, FacesThatACubeMapDoesNotHaveAreRefused) {
    EXPECT_THAT(refusal(
                    [](auto& b) {
                        pack::CopyImage(b, kCube, GL_TEXTURE_CUBE_MAP, 0, 0, 0, 4, kWords, GL_TEXTURE_2D, 0, 0, 0, 0, 1,
                                        1, 3);
                    },
                    true),
                HasSubstr("no such texture"));
    run([](auto& b) { pack::TexStorage(b, kCube, GL_TEXTURE_CUBE_MAP, 1, GL_RGBA8, kSize, kSize, 1, 0, 0); });
    Batch batch;
    batch.block(1, [](auto& b) {
        pack::CopyImage(b, kCube, GL_TEXTURE_CUBE_MAP, 0, 0, 0, 4, kCube, GL_TEXTURE_CUBE_MAP, 0, 0, 0, 0, 1, 1, 3);
    });
    const auto done = session_->run(batch);
    ASSERT_FALSE(done);
    EXPECT_THAT(done.error().message, HasSubstr("no such face"));
}

}  // namespace
}  // namespace wall::tileserver::test
