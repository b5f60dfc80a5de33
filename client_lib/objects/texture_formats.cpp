// SPDX-License-Identifier: MIT
#include "client_lib/objects/texture_formats.h"

#include <algorithm>
#include <iterator>

namespace wall::client {
namespace {

// What glGetTexLevelParameter answers on llvmpipe of Mesa 22.3, red, green, blue, alpha, luminance, intensity, depth,
// stencil; the type of the components of the first of them.
using enum ImageUse;
constexpr GLenum kUnsigned = GL_UNSIGNED_NORMALIZED, kSigned = GL_SIGNED_NORMALIZED;
constexpr TextureFormat kFormats[] = {
    {1, GL_LUMINANCE, 1, {0, 0, 0, 0, 8, 0, 0, 0}, kUnsigned, drawn},
    {2, GL_LUMINANCE_ALPHA, 2, {0, 0, 0, 8, 8, 0, 0, 0}, kUnsigned, drawn},
    {3, GL_RGB, 3, {8, 8, 8, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {4, GL_RGBA, 4, {8, 8, 8, 8, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_ALPHA, GL_ALPHA, GL_ALPHA, {0, 0, 0, 8, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_ALPHA4, GL_ALPHA, GL_ALPHA4, {0, 0, 0, 8, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_ALPHA8, GL_ALPHA, GL_ALPHA8, {0, 0, 0, 8, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_ALPHA12, GL_ALPHA, GL_ALPHA12, {0, 0, 0, 16, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_ALPHA16, GL_ALPHA, GL_ALPHA16, {0, 0, 0, 16, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE, GL_LUMINANCE, GL_LUMINANCE, {0, 0, 0, 0, 8, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE4, GL_LUMINANCE, GL_LUMINANCE4, {0, 0, 0, 0, 8, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE8, GL_LUMINANCE, GL_LUMINANCE8, {0, 0, 0, 0, 8, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE12, GL_LUMINANCE, GL_LUMINANCE12, {0, 0, 0, 0, 16, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE16, GL_LUMINANCE, GL_LUMINANCE16, {0, 0, 0, 0, 16, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, {0, 0, 0, 8, 8, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE4_ALPHA4, GL_LUMINANCE_ALPHA, GL_LUMINANCE4_ALPHA4, {0, 0, 0, 4, 4, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE6_ALPHA2, GL_LUMINANCE_ALPHA, GL_LUMINANCE6_ALPHA2, {0, 0, 0, 8, 8, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE8_ALPHA8, GL_LUMINANCE_ALPHA, GL_LUMINANCE8_ALPHA8, {0, 0, 0, 8, 8, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE12_ALPHA4, GL_LUMINANCE_ALPHA, GL_LUMINANCE12_ALPHA4, {0, 0, 0, 16, 16, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE12_ALPHA12, GL_LUMINANCE_ALPHA, GL_LUMINANCE12_ALPHA12, {0, 0, 0, 16, 16, 0, 0, 0}, kUnsigned, drawn},
    {GL_LUMINANCE16_ALPHA16, GL_LUMINANCE_ALPHA, GL_LUMINANCE16_ALPHA16, {0, 0, 0, 16, 16, 0, 0, 0}, kUnsigned, drawn},
    {GL_INTENSITY, GL_INTENSITY, GL_INTENSITY, {0, 0, 0, 0, 0, 8, 0, 0}, kUnsigned, drawn},
    {GL_INTENSITY4, GL_INTENSITY, GL_INTENSITY4, {0, 0, 0, 0, 0, 8, 0, 0}, kUnsigned, drawn},
    {GL_INTENSITY8, GL_INTENSITY, GL_INTENSITY8, {0, 0, 0, 0, 0, 8, 0, 0}, kUnsigned, drawn},
    {GL_INTENSITY12, GL_INTENSITY, GL_INTENSITY12, {0, 0, 0, 0, 0, 16, 0, 0}, kUnsigned, drawn},
    {GL_INTENSITY16, GL_INTENSITY, GL_INTENSITY16, {0, 0, 0, 0, 0, 16, 0, 0}, kUnsigned, drawn},
    {GL_RGB, GL_RGB, GL_RGB, {8, 8, 8, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_R3_G3_B2, GL_RGB, GL_R3_G3_B2, {3, 3, 2, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGB4, GL_RGB, GL_RGB4, {4, 4, 4, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGB5, GL_RGB, GL_RGB5, {5, 5, 5, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGB565, GL_RGB, GL_RGB565, {5, 6, 5, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGB8, GL_RGB, GL_RGB8, {8, 8, 8, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGB10, GL_RGB, GL_RGB10, {10, 10, 10, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGB12, GL_RGB, GL_RGB12, {16, 16, 16, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGB16, GL_RGB, GL_RGB16, {16, 16, 16, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGBA, GL_RGBA, GL_RGBA, {8, 8, 8, 8, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGBA2, GL_RGBA, GL_RGBA2, {4, 4, 4, 4, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGBA4, GL_RGBA, GL_RGBA4, {4, 4, 4, 4, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGB5_A1, GL_RGBA, GL_RGB5_A1, {5, 5, 5, 1, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGBA8, GL_RGBA, GL_RGBA8, {8, 8, 8, 8, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGB10_A2, GL_RGBA, GL_RGB10_A2, {10, 10, 10, 2, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGBA12, GL_RGBA, GL_RGBA12, {16, 16, 16, 16, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RGBA16, GL_RGBA, GL_RGBA16, {16, 16, 16, 16, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT, {0, 0, 0, 0, 0, 0, 16, 0}, kUnsigned, drawn},
    {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT16, {0, 0, 0, 0, 0, 0, 16, 0}, kUnsigned, drawn},
    {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT24, {0, 0, 0, 0, 0, 0, 24, 0}, kUnsigned, drawn},
    {GL_DEPTH_COMPONENT32, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT32, {0, 0, 0, 0, 0, 0, 32, 0}, kUnsigned, drawn},
    {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT32F, {0, 0, 0, 0, 0, 0, 32, 0}, GL_FLOAT, drawn},
    {GL_DEPTH_STENCIL, GL_DEPTH_STENCIL, GL_DEPTH_STENCIL, {0, 0, 0, 0, 0, 0, 24, 8}, kUnsigned, drawn},
    {GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_DEPTH24_STENCIL8, {0, 0, 0, 0, 0, 0, 24, 8}, kUnsigned, drawn},
    {GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_DEPTH32F_STENCIL8, {0, 0, 0, 0, 0, 0, 32, 8}, GL_FLOAT, drawn},
    {GL_COMPRESSED_ALPHA, GL_ALPHA, GL_ALPHA, {0, 0, 0, 8, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_COMPRESSED_LUMINANCE,
     GL_LUMINANCE,
     GL_COMPRESSED_LUMINANCE_LATC1_EXT,
     {0, 0, 0, 0, 8, 0, 0, 0},
     kUnsigned,
     blocks},
    {GL_COMPRESSED_LUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA,
     GL_COMPRESSED_LUMINANCE_ALPHA_LATC2_EXT,
     {0, 0, 0, 8, 8, 0, 0, 0},
     kUnsigned,
     blocks},
    {GL_COMPRESSED_INTENSITY, GL_INTENSITY, GL_INTENSITY, {0, 0, 0, 0, 0, 8, 0, 0}, kUnsigned, drawn},
    {GL_COMPRESSED_RGB, GL_RGB, GL_COMPRESSED_RGB_S3TC_DXT1_EXT, {4, 4, 4, 0, 0, 0, 0, 0}, kUnsigned, blocks},
    {GL_COMPRESSED_RGBA, GL_RGBA, GL_COMPRESSED_RGBA_S3TC_DXT5_EXT, {4, 4, 4, 4, 0, 0, 0, 0}, kUnsigned, blocks},
    {GL_COMPRESSED_RGB_S3TC_DXT1_EXT,
     GL_RGB,
     GL_COMPRESSED_RGB_S3TC_DXT1_EXT,
     {4, 4, 4, 0, 0, 0, 0, 0},
     kUnsigned,
     blocks},
    {GL_COMPRESSED_RGBA_S3TC_DXT1_EXT,
     GL_RGBA,
     GL_COMPRESSED_RGBA_S3TC_DXT1_EXT,
     {4, 4, 4, 4, 0, 0, 0, 0},
     kUnsigned,
     blocks},
    {GL_COMPRESSED_RGBA_S3TC_DXT3_EXT,
     GL_RGBA,
     GL_COMPRESSED_RGBA_S3TC_DXT3_EXT,
     {4, 4, 4, 4, 0, 0, 0, 0},
     kUnsigned,
     blocks},
    {GL_COMPRESSED_RGBA_S3TC_DXT5_EXT,
     GL_RGBA,
     GL_COMPRESSED_RGBA_S3TC_DXT5_EXT,
     {4, 4, 4, 4, 0, 0, 0, 0},
     kUnsigned,
     blocks},
    {GL_SRGB, GL_RGB, GL_SRGB, {8, 8, 8, 0, 0, 0, 0, 0}, kUnsigned, drawn, true},
    {GL_SRGB8, GL_RGB, GL_SRGB8, {8, 8, 8, 0, 0, 0, 0, 0}, kUnsigned, drawn, true},
    {GL_SRGB_ALPHA, GL_RGBA, GL_SRGB_ALPHA, {8, 8, 8, 8, 0, 0, 0, 0}, kUnsigned, drawn, true},
    {GL_SRGB8_ALPHA8, GL_RGBA, GL_SRGB8_ALPHA8, {8, 8, 8, 8, 0, 0, 0, 0}, kUnsigned, drawn, true},
    {GL_SLUMINANCE, GL_LUMINANCE, GL_SLUMINANCE, {0, 0, 0, 0, 8, 0, 0, 0}, kUnsigned, sampled, true},
    {GL_SLUMINANCE8, GL_LUMINANCE, GL_SLUMINANCE8, {0, 0, 0, 0, 8, 0, 0, 0}, kUnsigned, sampled, true},
    {GL_SLUMINANCE_ALPHA, GL_LUMINANCE_ALPHA, GL_SLUMINANCE_ALPHA, {0, 0, 0, 8, 8, 0, 0, 0}, kUnsigned, sampled, true},
    {GL_SLUMINANCE8_ALPHA8,
     GL_LUMINANCE_ALPHA,
     GL_SLUMINANCE8_ALPHA8,
     {0, 0, 0, 8, 8, 0, 0, 0},
     kUnsigned,
     sampled,
     true},
    {GL_RED, GL_RED, GL_RED, {8, 0, 0, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_R8, GL_RED, GL_R8, {8, 0, 0, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_R16, GL_RED, GL_R16, {16, 0, 0, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RG, GL_RG, GL_RG, {8, 8, 0, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RG8, GL_RG, GL_RG8, {8, 8, 0, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_RG16, GL_RG, GL_RG16, {16, 16, 0, 0, 0, 0, 0, 0}, kUnsigned, drawn},
    {GL_R16F, GL_RED, GL_R16F, {16, 0, 0, 0, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_R32F, GL_RED, GL_R32F, {32, 0, 0, 0, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_RG16F, GL_RG, GL_RG16F, {16, 16, 0, 0, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_RG32F, GL_RG, GL_RG32F, {32, 32, 0, 0, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_RGB16F, GL_RGB, GL_RGB16F, {16, 16, 16, 0, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_RGB32F, GL_RGB, GL_RGB32F, {32, 32, 32, 0, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_RGBA16F, GL_RGBA, GL_RGBA16F, {16, 16, 16, 16, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_RGBA32F, GL_RGBA, GL_RGBA32F, {32, 32, 32, 32, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_ALPHA16F_ARB, GL_ALPHA, GL_ALPHA16F_ARB, {0, 0, 0, 16, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_ALPHA32F_ARB, GL_ALPHA, GL_ALPHA32F_ARB, {0, 0, 0, 32, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_LUMINANCE16F_ARB, GL_LUMINANCE, GL_LUMINANCE16F_ARB, {0, 0, 0, 0, 16, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_LUMINANCE32F_ARB, GL_LUMINANCE, GL_LUMINANCE32F_ARB, {0, 0, 0, 0, 32, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_LUMINANCE_ALPHA16F_ARB,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA16F_ARB,
     {0, 0, 0, 16, 16, 0, 0, 0},
     GL_FLOAT,
     drawn},
    {GL_LUMINANCE_ALPHA32F_ARB,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA32F_ARB,
     {0, 0, 0, 32, 32, 0, 0, 0},
     GL_FLOAT,
     drawn},
    {GL_INTENSITY16F_ARB, GL_INTENSITY, GL_INTENSITY16F_ARB, {0, 0, 0, 0, 0, 16, 0, 0}, GL_FLOAT, drawn},
    {GL_INTENSITY32F_ARB, GL_INTENSITY, GL_INTENSITY32F_ARB, {0, 0, 0, 0, 0, 32, 0, 0}, GL_FLOAT, drawn},
    {GL_R11F_G11F_B10F, GL_RGB, GL_R11F_G11F_B10F, {11, 11, 10, 0, 0, 0, 0, 0}, GL_FLOAT, drawn},
    {GL_RGB9_E5, GL_RGB, GL_RGB9_E5, {9, 9, 9, 0, 0, 0, 0, 0}, GL_FLOAT, sampled},
    {GL_R8_SNORM, GL_RED, GL_R8_SNORM, {8, 0, 0, 0, 0, 0, 0, 0}, kSigned, drawn},
    {GL_RG8_SNORM, GL_RG, GL_RG8_SNORM, {8, 8, 0, 0, 0, 0, 0, 0}, kSigned, drawn},
    {GL_RGB8_SNORM, GL_RGB, GL_RGB8_SNORM, {8, 8, 8, 0, 0, 0, 0, 0}, kSigned, drawn},
    {GL_RGBA8_SNORM, GL_RGBA, GL_RGBA8_SNORM, {8, 8, 8, 8, 0, 0, 0, 0}, kSigned, drawn},
    {GL_R16_SNORM, GL_RED, GL_R16_SNORM, {16, 0, 0, 0, 0, 0, 0, 0}, kSigned, drawn},
    {GL_RG16_SNORM, GL_RG, GL_RG16_SNORM, {16, 16, 0, 0, 0, 0, 0, 0}, kSigned, drawn},
    {GL_RGB16_SNORM, GL_RGB, GL_RGB16_SNORM, {16, 16, 16, 0, 0, 0, 0, 0}, kSigned, drawn},
    {GL_RGBA16_SNORM, GL_RGBA, GL_RGBA16_SNORM, {16, 16, 16, 16, 0, 0, 0, 0}, kSigned, drawn},
    {GL_R8I, GL_RED, GL_R8I, {8, 0, 0, 0, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_R8UI, GL_RED, GL_R8UI, {8, 0, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RGBA8I, GL_RGBA, GL_RGBA8I, {8, 8, 8, 8, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_RGBA8UI, GL_RGBA, GL_RGBA8UI, {8, 8, 8, 8, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RGBA16I, GL_RGBA, GL_RGBA16I, {16, 16, 16, 16, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_RGBA16UI, GL_RGBA, GL_RGBA16UI, {16, 16, 16, 16, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RGBA32I, GL_RGBA, GL_RGBA32I, {32, 32, 32, 32, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_RGBA32UI, GL_RGBA, GL_RGBA32UI, {32, 32, 32, 32, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_COMPRESSED_RED, GL_RED, GL_COMPRESSED_RED_RGTC1, {8, 0, 0, 0, 0, 0, 0, 0}, kUnsigned, blocks},
    {GL_COMPRESSED_RG, GL_RG, GL_COMPRESSED_RG_RGTC2, {8, 8, 0, 0, 0, 0, 0, 0}, kUnsigned, blocks},
    {GL_COMPRESSED_SRGB, GL_RGB, GL_COMPRESSED_SRGB_S3TC_DXT1_EXT, {4, 4, 4, 0, 0, 0, 0, 0}, kUnsigned, blocks, true},
    {GL_COMPRESSED_SRGB_ALPHA,
     GL_RGBA,
     GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT,
     {4, 4, 4, 4, 0, 0, 0, 0},
     kUnsigned,
     blocks,
     true},
    {GL_STENCIL_INDEX8, GL_STENCIL_INDEX, GL_STENCIL_INDEX8, {0, 0, 0, 0, 0, 0, 0, 8}, 0, drawn},
    {GL_R16I, GL_RED, GL_R16I, {16, 0, 0, 0, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_R16UI, GL_RED, GL_R16UI, {16, 0, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_R32I, GL_RED, GL_R32I, {32, 0, 0, 0, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_R32UI, GL_RED, GL_R32UI, {32, 0, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RG8I, GL_RG, GL_RG8I, {8, 8, 0, 0, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_RG8UI, GL_RG, GL_RG8UI, {8, 8, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RG16I, GL_RG, GL_RG16I, {16, 16, 0, 0, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_RG16UI, GL_RG, GL_RG16UI, {16, 16, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RG32I, GL_RG, GL_RG32I, {32, 32, 0, 0, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_RG32UI, GL_RG, GL_RG32UI, {32, 32, 0, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RGB8I, GL_RGB, GL_RGB8I, {8, 8, 8, 0, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_RGB8UI, GL_RGB, GL_RGB8UI, {8, 8, 8, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RGB16I, GL_RGB, GL_RGB16I, {16, 16, 16, 0, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_RGB16UI, GL_RGB, GL_RGB16UI, {16, 16, 16, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RGB32I, GL_RGB, GL_RGB32I, {32, 32, 32, 0, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_RGB32UI, GL_RGB, GL_RGB32UI, {32, 32, 32, 0, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_ALPHA8I_EXT, GL_ALPHA, GL_ALPHA8I_EXT, {0, 0, 0, 8, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_ALPHA8UI_EXT, GL_ALPHA, GL_ALPHA8UI_EXT, {0, 0, 0, 8, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_ALPHA16I_EXT, GL_ALPHA, GL_ALPHA16I_EXT, {0, 0, 0, 16, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_ALPHA16UI_EXT, GL_ALPHA, GL_ALPHA16UI_EXT, {0, 0, 0, 16, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_ALPHA32I_EXT, GL_ALPHA, GL_ALPHA32I_EXT, {0, 0, 0, 32, 0, 0, 0, 0}, GL_INT, drawn},
    {GL_ALPHA32UI_EXT, GL_ALPHA, GL_ALPHA32UI_EXT, {0, 0, 0, 32, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_LUMINANCE8I_EXT, GL_LUMINANCE, GL_LUMINANCE8I_EXT, {0, 0, 0, 0, 8, 0, 0, 0}, GL_INT, drawn},
    {GL_LUMINANCE8UI_EXT, GL_LUMINANCE, GL_LUMINANCE8UI_EXT, {0, 0, 0, 0, 8, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_LUMINANCE16I_EXT, GL_LUMINANCE, GL_LUMINANCE16I_EXT, {0, 0, 0, 0, 16, 0, 0, 0}, GL_INT, drawn},
    {GL_LUMINANCE16UI_EXT, GL_LUMINANCE, GL_LUMINANCE16UI_EXT, {0, 0, 0, 0, 16, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_LUMINANCE32I_EXT, GL_LUMINANCE, GL_LUMINANCE32I_EXT, {0, 0, 0, 0, 32, 0, 0, 0}, GL_INT, drawn},
    {GL_LUMINANCE32UI_EXT, GL_LUMINANCE, GL_LUMINANCE32UI_EXT, {0, 0, 0, 0, 32, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_LUMINANCE_ALPHA8I_EXT, GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA8I_EXT, {0, 0, 0, 8, 8, 0, 0, 0}, GL_INT, drawn},
    {GL_LUMINANCE_ALPHA8UI_EXT,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA8UI_EXT,
     {0, 0, 0, 8, 8, 0, 0, 0},
     GL_UNSIGNED_INT,
     drawn},
    {GL_LUMINANCE_ALPHA16I_EXT,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA16I_EXT,
     {0, 0, 0, 16, 16, 0, 0, 0},
     GL_INT,
     drawn},
    {GL_LUMINANCE_ALPHA16UI_EXT,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA16UI_EXT,
     {0, 0, 0, 16, 16, 0, 0, 0},
     GL_UNSIGNED_INT,
     drawn},
    {GL_LUMINANCE_ALPHA32I_EXT,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA32I_EXT,
     {0, 0, 0, 32, 32, 0, 0, 0},
     GL_INT,
     drawn},
    {GL_LUMINANCE_ALPHA32UI_EXT,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA32UI_EXT,
     {0, 0, 0, 32, 32, 0, 0, 0},
     GL_UNSIGNED_INT,
     drawn},
    {GL_INTENSITY8I_EXT, GL_INTENSITY, GL_INTENSITY8I_EXT, {0, 0, 0, 0, 0, 8, 0, 0}, GL_INT, drawn},
    {GL_INTENSITY8UI_EXT, GL_INTENSITY, GL_INTENSITY8UI_EXT, {0, 0, 0, 0, 0, 8, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_INTENSITY16I_EXT, GL_INTENSITY, GL_INTENSITY16I_EXT, {0, 0, 0, 0, 0, 16, 0, 0}, GL_INT, drawn},
    {GL_INTENSITY16UI_EXT, GL_INTENSITY, GL_INTENSITY16UI_EXT, {0, 0, 0, 0, 0, 16, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_INTENSITY32I_EXT, GL_INTENSITY, GL_INTENSITY32I_EXT, {0, 0, 0, 0, 0, 32, 0, 0}, GL_INT, drawn},
    {GL_INTENSITY32UI_EXT, GL_INTENSITY, GL_INTENSITY32UI_EXT, {0, 0, 0, 0, 0, 32, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_RGB10_A2UI, GL_RGBA, GL_RGB10_A2UI, {10, 10, 10, 2, 0, 0, 0, 0}, GL_UNSIGNED_INT, drawn},
    {GL_COMPRESSED_RED_RGTC1, GL_RED, GL_COMPRESSED_RED_RGTC1, {8, 0, 0, 0, 0, 0, 0, 0}, kUnsigned, blocks},
    {GL_COMPRESSED_SIGNED_RED_RGTC1, GL_RED, GL_COMPRESSED_SIGNED_RED_RGTC1, {8, 0, 0, 0, 0, 0, 0, 0}, kSigned, blocks},
    {GL_COMPRESSED_RG_RGTC2, GL_RG, GL_COMPRESSED_RG_RGTC2, {8, 8, 0, 0, 0, 0, 0, 0}, kUnsigned, blocks},
    {GL_COMPRESSED_SIGNED_RG_RGTC2, GL_RG, GL_COMPRESSED_SIGNED_RG_RGTC2, {8, 8, 0, 0, 0, 0, 0, 0}, kSigned, blocks},
    {GL_COMPRESSED_SLUMINANCE, GL_LUMINANCE, GL_LUMINANCE, {0, 0, 0, 0, 8, 0, 0, 0}, kUnsigned, sampled, true},
    {GL_COMPRESSED_SLUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE_ALPHA,
     {0, 0, 0, 8, 8, 0, 0, 0},
     kUnsigned,
     sampled,
     true},
    {GL_COMPRESSED_SRGB_S3TC_DXT1_EXT,
     GL_RGB,
     GL_COMPRESSED_SRGB_S3TC_DXT1_EXT,
     {4, 4, 4, 0, 0, 0, 0, 0},
     kUnsigned,
     blocks,
     true},
    {GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT,
     GL_RGBA,
     GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT,
     {4, 4, 4, 4, 0, 0, 0, 0},
     kUnsigned,
     blocks,
     true},
    {GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT,
     GL_RGBA,
     GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT,
     {4, 4, 4, 4, 0, 0, 0, 0},
     kUnsigned,
     blocks,
     true},
    {GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT,
     GL_RGBA,
     GL_COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT,
     {4, 4, 4, 4, 0, 0, 0, 0},
     kUnsigned,
     blocks,
     true},
    {GL_ALPHA8_SNORM, GL_ALPHA, GL_ALPHA8_SNORM, {0, 0, 0, 8, 0, 0, 0, 0}, kSigned, drawn},
    {GL_ALPHA_SNORM, GL_ALPHA, GL_ALPHA_SNORM, {0, 0, 0, 8, 0, 0, 0, 0}, kSigned, drawn},
    {GL_LUMINANCE8_SNORM, GL_LUMINANCE, GL_LUMINANCE8_SNORM, {0, 0, 0, 0, 8, 0, 0, 0}, kSigned, drawn},
    {GL_LUMINANCE_SNORM, GL_LUMINANCE, GL_LUMINANCE_SNORM, {0, 0, 0, 0, 8, 0, 0, 0}, kSigned, drawn},
    {GL_INTENSITY_SNORM, GL_INTENSITY, GL_INTENSITY_SNORM, {0, 0, 0, 0, 0, 8, 0, 0}, kSigned, drawn},
    {GL_RED_SNORM, GL_RED, GL_RED_SNORM, {8, 0, 0, 0, 0, 0, 0, 0}, kSigned, drawn},
    {GL_RG_SNORM, GL_RG, GL_RG_SNORM, {8, 8, 0, 0, 0, 0, 0, 0}, kSigned, drawn},
    {GL_RGB_SNORM, GL_RGB, GL_RGB_SNORM, {8, 8, 8, 0, 0, 0, 0, 0}, kSigned, drawn},
    {GL_RGBA_SNORM, GL_RGBA, GL_RGBA_SNORM, {8, 8, 8, 8, 0, 0, 0, 0}, kSigned, drawn},
    {GL_LUMINANCE8_ALPHA8_SNORM,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE8_ALPHA8_SNORM,
     {0, 0, 0, 8, 8, 0, 0, 0},
     kSigned,
     drawn},
    {GL_INTENSITY8_SNORM, GL_INTENSITY, GL_INTENSITY8_SNORM, {0, 0, 0, 0, 0, 8, 0, 0}, kSigned, drawn},
    {GL_ALPHA16_SNORM, GL_ALPHA, GL_ALPHA16_SNORM, {0, 0, 0, 16, 0, 0, 0, 0}, kSigned, drawn},
    {GL_LUMINANCE16_SNORM, GL_LUMINANCE, GL_LUMINANCE16_SNORM, {0, 0, 0, 0, 16, 0, 0, 0}, kSigned, drawn},
    {GL_LUMINANCE16_ALPHA16_SNORM,
     GL_LUMINANCE_ALPHA,
     GL_LUMINANCE16_ALPHA16_SNORM,
     {0, 0, 0, 16, 16, 0, 0, 0},
     kSigned,
     drawn},
    {GL_INTENSITY16_SNORM, GL_INTENSITY, GL_INTENSITY16_SNORM, {0, 0, 0, 0, 0, 16, 0, 0}, kSigned, drawn},
    {GL_LUMINANCE_ALPHA_SNORM, GL_LUMINANCE_ALPHA, GL_LUMINANCE_ALPHA_SNORM, {0, 0, 0, 8, 8, 0, 0, 0}, kSigned, drawn},
};

/// Unsized formats for which the driver takes the storage of the pixels when they fit (st_choose_matching_format).
struct Matching {
    GLenum base, format, type;
    ComponentBits bits;
};
constexpr Matching kMatching[] = {
    {GL_RGB, GL_RGB, GL_UNSIGNED_SHORT_5_6_5, {5, 6, 5, 0, 0, 0, 0, 0}},
    {GL_RGB, GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1, {5, 5, 5, 0, 0, 0, 0, 0}},
    {GL_RGB, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, {10, 10, 10, 0, 0, 0, 0, 0}},
    {GL_RGB, GL_RGB, GL_UNSIGNED_BYTE_3_3_2, {3, 3, 2, 0, 0, 0, 0, 0}},
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_SHORT_4_4_4_4, {4, 4, 4, 4, 0, 0, 0, 0}},
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_SHORT_5_5_5_1, {5, 5, 5, 1, 0, 0, 0, 0}},
    {GL_RGBA, GL_BGRA, GL_UNSIGNED_SHORT_1_5_5_5_REV, {5, 5, 5, 1, 0, 0, 0, 0}},
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV, {10, 10, 10, 2, 0, 0, 0, 0}},
};

}  // namespace

const TextureFormat* find_texture_format(GLint internal_format) {
    const auto* at = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const TextureFormat& row) { return row.internal_format == internal_format; });
    return at == std::end(kFormats) ? nullptr : at;
}

bool is_sized(const TextureFormat& format) {
    const auto internal = static_cast<GLenum>(format.internal_format);
    if (internal <= 4 || internal == format.base || format.answer != format.internal_format) return false;
    switch (internal) {
        case GL_SRGB:
        case GL_SRGB_ALPHA:
        case GL_SLUMINANCE:
        case GL_SLUMINANCE_ALPHA:
        case GL_RED_SNORM:
        case GL_RG_SNORM:
        case GL_RGB_SNORM:
        case GL_RGBA_SNORM:
        case GL_ALPHA_SNORM:
        case GL_LUMINANCE_SNORM:
        case GL_LUMINANCE_ALPHA_SNORM:
        case GL_INTENSITY_SNORM: return false;
        default: return true;
    }
}

PixelKind exact_pixels(const TextureFormat& format, const ComponentBits& bits) {
    const bool real = format.component_type == GL_FLOAT || format.component_type == GL_SIGNED_NORMALIZED;
    switch (format.base) {
        case GL_DEPTH_COMPONENT: return {GL_DEPTH_COMPONENT, real ? GLenum{GL_FLOAT} : GLenum{GL_UNSIGNED_INT}};
        case GL_DEPTH_STENCIL:
            return {GL_DEPTH_STENCIL, real ? GLenum{GL_FLOAT_32_UNSIGNED_INT_24_8_REV} : GLenum{GL_UNSIGNED_INT_24_8}};
        case GL_STENCIL_INDEX: return {GL_STENCIL_INDEX, GL_UNSIGNED_BYTE};
        default: break;
    }
    if (format.whole()) return {GL_RGBA_INTEGER, format.component_type};
    if (real) return {GL_RGBA, GL_FLOAT};
    const bool bytes = std::max({bits.red, bits.green, bits.blue, bits.alpha, bits.luminance, bits.intensity}) <= 8;
    return {GL_RGBA, bytes ? GLenum{GL_UNSIGNED_BYTE} : GLenum{GL_UNSIGNED_SHORT}};
}

ComponentBits stored_bits(const TextureFormat& row, GLenum format, GLenum type) {
    const auto internal = static_cast<GLenum>(row.internal_format);
    if (internal == GL_DEPTH_COMPONENT && type != GL_UNSIGNED_SHORT)
        return {0, 0, 0, 0, 0, 0, static_cast<std::uint8_t>(type == GL_UNSIGNED_INT ? 32 : 24), 0};
    if (internal != GL_RGB && internal != GL_RGBA) return row.bits;
    for (const Matching& m : kMatching)
        if (m.base == internal && m.format == format && m.type == type) return m.bits;
    return row.bits;
}

}  // namespace wall::client
