// SPDX-License-Identifier: MIT
// Pixel images against Mesa: what glPixelStore makes of a program's memory, in both directions.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "common/glapi/image.h"
#include "tests/unit/mesa_context.h"

namespace wall::glapi {
namespace {

struct Pair {
    GLenum format, type;
    GLint internal;
};

// Formats that a texture keeps exactly, so that a round trip through Mesa changes nothing.
constexpr Pair kPairs[] = {
    {GL_RGBA, GL_UNSIGNED_BYTE, GL_RGBA8},
    {GL_RGB, GL_UNSIGNED_BYTE, GL_RGB8},
    {GL_BGRA, GL_UNSIGNED_BYTE, GL_RGBA8},
    {GL_ALPHA, GL_UNSIGNED_BYTE, GL_ALPHA8},
    {GL_LUMINANCE_ALPHA, GL_UNSIGNED_BYTE, GL_LUMINANCE8_ALPHA8},
    {GL_RGBA, GL_UNSIGNED_SHORT, GL_RGBA16},
    {GL_RGBA, GL_FLOAT, GL_RGBA32F},
    {GL_RGB, GL_UNSIGNED_SHORT_5_6_5, GL_RGB565},
    {GL_RGBA, GL_UNSIGNED_INT_8_8_8_8, GL_RGBA8},
    {GL_RED, GL_UNSIGNED_BYTE, GL_R8},
};

PixelStore store_of(unsigned variant) {
    PixelStore s;
    s.alignment = 1 << (variant % 4);
    s.swap_bytes = variant & 4;
    if (variant & 8) s.row_length = 23, s.skip_pixels = 3;
    if (variant & 16) s.skip_rows = 2;
    if (variant & 32) s.image_height = 17, s.skip_images = 1;
    return s;
}

struct StoreNames {
    GLenum swap, alignment, row_length, skip_pixels, skip_rows, image_height, skip_images;
};
constexpr StoreNames kUnpack = {GL_UNPACK_SWAP_BYTES,  GL_UNPACK_ALIGNMENT, GL_UNPACK_ROW_LENGTH,
                                GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS, GL_UNPACK_IMAGE_HEIGHT,
                                GL_UNPACK_SKIP_IMAGES};
constexpr StoreNames kPack = {GL_PACK_SWAP_BYTES, GL_PACK_ALIGNMENT,    GL_PACK_ROW_LENGTH, GL_PACK_SKIP_PIXELS,
                              GL_PACK_SKIP_ROWS,  GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_IMAGES};

void apply(const GlFunctions& gl, const StoreNames& names, const PixelStore& s) {
    gl.PixelStorei(names.swap, s.swap_bytes);
    gl.PixelStorei(names.alignment, s.alignment);
    gl.PixelStorei(names.row_length, s.row_length);
    gl.PixelStorei(names.skip_pixels, s.skip_pixels);
    gl.PixelStorei(names.skip_rows, s.skip_rows);
    gl.PixelStorei(names.image_height, s.image_height);
    gl.PixelStorei(names.skip_images, s.skip_images);
}

std::vector<std::byte> noise(std::size_t bytes, GLenum type) {
    std::mt19937 random(1);
    std::vector<std::byte> out(bytes);
    for (auto& b : out) b = static_cast<std::byte>(random());
    if (type == GL_FLOAT) {  // no NaN
        std::vector<float> values(bytes / 4);
        for (float& v : values) v = static_cast<float>(random() % 1000) / 16;
        std::memcpy(out.data(), values.data(), values.size() * 4);
    }
    return out;
}

PixelStore tight_store() {
    PixelStore s;
    s.alignment = 1;
    return s;
}

TEST(Image, UnpacksAndPacksAsMesaDoes) {
    const auto mesa = test::MesaContext::open();
    if (!mesa) GTEST_SKIP() << "no Mesa here";
    const auto& gl = mesa->gl;
    for (const Pair& pair : kPairs)
        for (unsigned variant = 0; variant < 64; ++variant) {
            SCOPED_TRACE(testing::Message()
                         << std::hex << pair.format << ' ' << pair.type << std::dec << " variant " << variant);
            PixelStore store = store_of(variant);
            if (pair.type == GL_FLOAT && store.swap_bytes) continue;  // swapped noise has NaN
            if (store.swap_bytes && variant > 7) continue;  // Mesa 22.3 swaps too little of an image with skips
            const unsigned dimensions = variant & 32 ? 3 : 2;
            const GLenum target = dimensions == 3 ? GL_TEXTURE_3D : GL_TEXTURE_2D;
            const ImageSize size{13, 11, dimensions == 3 ? 3 : 1, dimensions};
            const auto memory = noise(memory_bytes(store, size, pair.format, pair.type) + 16, pair.type);
            apply(gl, kUnpack, store);
            if (dimensions == 3)
                gl.TexImage3D(target, 0, pair.internal, size.width, size.height, size.depth, 0, pair.format, pair.type,
                              memory.data());
            else
                gl.TexImage2D(target, 0, pair.internal, size.width, size.height, 0, pair.format, pair.type,
                              memory.data());

            const auto tight = unpack_image(store, size, pair.format, pair.type, memory.data());
            std::vector<std::byte> expected(tight.size());
            apply(gl, kPack, tight_store());
            gl.GetTexImage(target, 0, pair.format, pair.type, expected.data());
            ASSERT_EQ(gl.GetError(), GLenum{GL_NO_ERROR});
            ASSERT_EQ(tight, expected);

            std::vector<std::byte> packed(memory.size(), std::byte{0x5a}), expected_packed = packed;
            apply(gl, kPack, store);
            gl.GetTexImage(target, 0, pair.format, pair.type, expected_packed.data());
            pack_image(store, size, pair.format, pair.type, tight, packed.data());
            ASSERT_EQ(packed, expected_packed);
        }
}

TEST(Image, UnpacksBitmapsAsMesaDoes) {
    const auto mesa = test::MesaContext::open();
    if (!mesa) GTEST_SKIP() << "no Mesa here";
    const auto& gl = mesa->gl;
    const auto memory = noise(2048, GL_BITMAP);
    for (unsigned variant = 0; variant < 64; ++variant) {
        PixelStore store = store_of(variant & ~32u);
        store.lsb_first = variant & 32;
        store.row_length = variant & 8 ? 45 : 0;
        apply(gl, kUnpack, store);
        gl.PixelStorei(GL_UNPACK_LSB_FIRST, store.lsb_first);
        gl.PolygonStipple(reinterpret_cast<const GLubyte*>(memory.data()));
        std::vector<std::byte> expected(128);
        apply(gl, kPack, tight_store());
        gl.GetPolygonStipple(reinterpret_cast<GLubyte*>(expected.data()));
        EXPECT_EQ(unpack_image(store, {32, 32}, GL_COLOR_INDEX, GL_BITMAP, memory.data()), expected) << variant;
    }
}

TEST(Image, RefusesTheSamePairsAsMesa) {
    const auto mesa = test::MesaContext::open();
    if (!mesa) GTEST_SKIP() << "no Mesa here";
    const auto& gl = mesa->gl;
    constexpr GLenum kFormats[] = {GL_RED, GL_ALPHA, GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_RG, GL_RGB,
                                   GL_BGR, GL_RGBA,  GL_BGRA,      GL_ABGR_EXT,        0x1234};
    constexpr GLenum kTypes[] = {GL_BYTE,
                                 GL_UNSIGNED_BYTE,
                                 GL_SHORT,
                                 GL_UNSIGNED_SHORT,
                                 GL_INT,
                                 GL_UNSIGNED_INT,
                                 GL_FLOAT,
                                 GL_HALF_FLOAT,
                                 GL_UNSIGNED_BYTE_3_3_2,
                                 GL_UNSIGNED_SHORT_5_6_5_REV,
                                 GL_UNSIGNED_SHORT_4_4_4_4,
                                 GL_UNSIGNED_SHORT_1_5_5_5_REV,
                                 GL_UNSIGNED_SHORT_4_4_4_4_REV,
                                 GL_UNSIGNED_SHORT_5_5_5_1,
                                 GL_UNSIGNED_INT_10_10_10_2,
                                 GL_UNSIGNED_INT_8_8_8_8,
                                 GL_UNSIGNED_INT_8_8_8_8_REV,
                                 GL_UNSIGNED_INT_2_10_10_10_REV,
                                 GL_UNSIGNED_INT_10F_11F_11F_REV,
                                 GL_UNSIGNED_INT_5_9_9_9_REV,
                                 GL_UNSIGNED_INT_24_8,
                                 GL_BITMAP,
                                 0x1234};
    for (const GLenum format : kFormats)
        for (const GLenum type : kTypes) {
            gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 4, 4, 0, format, type, nullptr);
            EXPECT_EQ(format_type_error(format, type), gl.GetError()) << std::hex << format << ' ' << type;
        }
}

TEST(Image, SizesDoNotOverflow) {
    EXPECT_EQ(image_bytes(GL_RGBA, GL_UNSIGNED_BYTE, 16384, 16384, 1), std::size_t{1} << 30);
    EXPECT_FALSE(image_bytes(GL_RGBA, GL_FLOAT, 0x7fffffff, 0x7fffffff, 0x7fffffff));
    EXPECT_FALSE(image_bytes(GL_RGBA, GL_FLOAT, -1, 1, 1));
    EXPECT_FALSE(image_bytes(GL_RGBA, GL_UNSIGNED_SHORT_5_6_5, 1, 1, 1));
    EXPECT_EQ(image_bytes(GL_RGBA, GL_FLOAT, 0, 5, 1), 0u);
    EXPECT_EQ(image_bytes(GL_COLOR_INDEX, GL_BITMAP, 9, 3, 1), 6u);
}

}  // namespace
}  // namespace wall::glapi
