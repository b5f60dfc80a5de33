// SPDX-License-Identifier: MIT
#include "client_lib/objects/view_formats.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "common/glapi/block_formats.h"

namespace wall::client {
namespace {

using enum ViewClass;
constexpr PixelKind kBlocks{0, 0};
constexpr ViewFormat kViewFormats[] = {
    {GL_RGBA32F, bits_128, {GL_RGBA, GL_FLOAT}},
    {GL_RGBA32UI, bits_128, {GL_RGBA_INTEGER, GL_UNSIGNED_INT}},
    {GL_RGBA32I, bits_128, {GL_RGBA_INTEGER, GL_INT}},
    {GL_RGB32F, bits_96, {GL_RGB, GL_FLOAT}},
    {GL_RGB32UI, bits_96, {GL_RGB_INTEGER, GL_UNSIGNED_INT}},
    {GL_RGB32I, bits_96, {GL_RGB_INTEGER, GL_INT}},
    {GL_RGBA16F, bits_64, {GL_RGBA, GL_HALF_FLOAT}},
    {GL_RG32F, bits_64, {GL_RG, GL_FLOAT}},
    {GL_RGBA16UI, bits_64, {GL_RGBA_INTEGER, GL_UNSIGNED_SHORT}},
    {GL_RG32UI, bits_64, {GL_RG_INTEGER, GL_UNSIGNED_INT}},
    {GL_RGBA16I, bits_64, {GL_RGBA_INTEGER, GL_SHORT}},
    {GL_RG32I, bits_64, {GL_RG_INTEGER, GL_INT}},
    {GL_RGBA16, bits_64, {GL_RGBA, GL_UNSIGNED_SHORT}},
    {GL_RGBA16_SNORM, bits_64, {GL_RGBA, GL_SHORT}},
    {GL_RGB16, bits_48, {GL_RGB, GL_UNSIGNED_SHORT}},
    {GL_RGB16_SNORM, bits_48, {GL_RGB, GL_SHORT}},
    {GL_RGB16F, bits_48, {GL_RGB, GL_HALF_FLOAT}},
    {GL_RGB16UI, bits_48, {GL_RGB_INTEGER, GL_UNSIGNED_SHORT}},
    {GL_RGB16I, bits_48, {GL_RGB_INTEGER, GL_SHORT}},
    {GL_RG16F, bits_32, {GL_RG, GL_HALF_FLOAT}},
    {GL_R11F_G11F_B10F, bits_32, {GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV}},
    {GL_R32F, bits_32, {GL_RED, GL_FLOAT}},
    {GL_RGB10_A2UI, bits_32, {GL_RGBA_INTEGER, GL_UNSIGNED_INT_2_10_10_10_REV}},
    {GL_RGBA8UI, bits_32, {GL_RGBA_INTEGER, GL_UNSIGNED_BYTE}},
    {GL_RG16UI, bits_32, {GL_RG_INTEGER, GL_UNSIGNED_SHORT}},
    {GL_R32UI, bits_32, {GL_RED_INTEGER, GL_UNSIGNED_INT}},
    {GL_RGBA8I, bits_32, {GL_RGBA_INTEGER, GL_BYTE}},
    {GL_RG16I, bits_32, {GL_RG_INTEGER, GL_SHORT}},
    {GL_R32I, bits_32, {GL_RED_INTEGER, GL_INT}},
    {GL_RGB10_A2, bits_32, {GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV}},
    {GL_RGBA8, bits_32, {GL_RGBA, GL_UNSIGNED_BYTE}},
    {GL_RG16, bits_32, {GL_RG, GL_UNSIGNED_SHORT}},
    {GL_RGBA8_SNORM, bits_32, {GL_RGBA, GL_BYTE}},
    {GL_RG16_SNORM, bits_32, {GL_RG, GL_SHORT}},
    {GL_SRGB8_ALPHA8, bits_32, {GL_RGBA, GL_UNSIGNED_BYTE}},
    {GL_RGB9_E5, bits_32, {GL_RGB, GL_UNSIGNED_INT_5_9_9_9_REV}},
    {GL_RGB8, bits_24, {GL_RGB, GL_UNSIGNED_BYTE}},
    {GL_RGB8_SNORM, bits_24, {GL_RGB, GL_BYTE}},
    {GL_SRGB8, bits_24, {GL_RGB, GL_UNSIGNED_BYTE}},
    {GL_RGB8UI, bits_24, {GL_RGB_INTEGER, GL_UNSIGNED_BYTE}},
    {GL_RGB8I, bits_24, {GL_RGB_INTEGER, GL_BYTE}},
    {GL_R16F, bits_16, {GL_RED, GL_HALF_FLOAT}},
    {GL_RG8UI, bits_16, {GL_RG_INTEGER, GL_UNSIGNED_BYTE}},
    {GL_R16UI, bits_16, {GL_RED_INTEGER, GL_UNSIGNED_SHORT}},
    {GL_RG8I, bits_16, {GL_RG_INTEGER, GL_BYTE}},
    {GL_R16I, bits_16, {GL_RED_INTEGER, GL_SHORT}},
    {GL_RG8, bits_16, {GL_RG, GL_UNSIGNED_BYTE}},
    {GL_R16, bits_16, {GL_RED, GL_UNSIGNED_SHORT}},
    {GL_RG8_SNORM, bits_16, {GL_RG, GL_BYTE}},
    {GL_R16_SNORM, bits_16, {GL_RED, GL_SHORT}},
    {GL_R8UI, bits_8, {GL_RED_INTEGER, GL_UNSIGNED_BYTE}},
    {GL_R8I, bits_8, {GL_RED_INTEGER, GL_BYTE}},
    {GL_R8, bits_8, {GL_RED, GL_UNSIGNED_BYTE}},
    {GL_R8_SNORM, bits_8, {GL_RED, GL_BYTE}},
    {GL_COMPRESSED_RED_RGTC1, rgtc1_red, kBlocks},
    {GL_COMPRESSED_SIGNED_RED_RGTC1, rgtc1_red, kBlocks},
    {GL_COMPRESSED_RG_RGTC2, rgtc2_rg, kBlocks},
    {GL_COMPRESSED_SIGNED_RG_RGTC2, rgtc2_rg, kBlocks},
    {GL_COMPRESSED_RGB_S3TC_DXT1_EXT, s3tc_dxt1_rgb, kBlocks},
    {GL_COMPRESSED_SRGB_S3TC_DXT1_EXT, s3tc_dxt1_rgb, kBlocks},
    {GL_COMPRESSED_RGBA_S3TC_DXT1_EXT, s3tc_dxt1_rgba, kBlocks},
    {GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT, s3tc_dxt1_rgba, kBlocks},
    {GL_COMPRESSED_RGBA_S3TC_DXT3_EXT, s3tc_dxt3_rgba, kBlocks},
    {GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT, s3tc_dxt3_rgba, kBlocks},
    {GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, s3tc_dxt5_rgba, kBlocks},
    {GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT, s3tc_dxt5_rgba, kBlocks},
};

/// Of the texels that blocks of a compressed format are as large as; nothing: it is none, or has no such row.
std::optional<ViewClass> texels_like_blocks(GLint internal_format, bool es) {
    const auto word = static_cast<GLenum>(internal_format);
    if (glapi::is_only_given(word) && !es) return std::nullopt;
    switch (glapi::block_bytes(word)) {
        case 8: return bits_64;
        case 16: return bits_128;
        default: return std::nullopt;
    }
}

}  // namespace

const ViewFormat* find_view_format(GLint internal_format) {
    const auto* at = std::ranges::find(kViewFormats, internal_format, &ViewFormat::internal_format);
    return at == std::end(kViewFormats) ? nullptr : at;
}

bool may_view(GLint of, GLint as) {
    if (of == as) return true;
    const ViewFormat *from = find_view_format(of), *to = find_view_format(as);
    return from && to && from->view_class == to->view_class;
}

bool may_copy_texels(GLint from, GLint to, bool es) {
    if (may_view(from, to)) return true;
    const auto fits = [&](GLint blocks, GLint texels) {
        const auto wanted = texels_like_blocks(blocks, es);
        const ViewFormat* row = find_view_format(texels);
        return wanted && row && row->view_class == *wanted;
    };
    return fits(from, to) || fits(to, from);
}

}  // namespace wall::client
