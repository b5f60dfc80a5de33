// SPDX-License-Identifier: MIT
#include "client_lib/objects/block_store.h"

#include <gtest/gtest.h>

namespace wall::client {
namespace {

constexpr BlockImage kVolume{GL_COMPRESSED_RGBA_BPTC_UNORM, {8, 5, 2, 3}};  // 2 x 2 blocks a slice

glapi::PixelStore store_of_blocks() {
    glapi::PixelStore store;
    store.block_width = store.block_height = 4;
    store.block_depth = 1;
    store.block_bytes = 16;
    return store;
}

TEST(BlockStore, IsTightWithoutTheSizeOfABlock) {
    glapi::PixelStore store;
    store.row_length = 100, store.image_height = 100;
    store.skip_pixels = store.skip_rows = store.skip_images = 3;
    EXPECT_EQ(block_store_error(store, 3), GLenum{GL_NO_ERROR});
    EXPECT_EQ(block_memory_bytes(store, kVolume), 8u * 16);
    store.block_height = 4, store.block_depth = 1, store.block_bytes = 16;
    EXPECT_EQ(block_memory_bytes(store, kVolume), 8u * 16) << "nor without the first of its sides";
    EXPECT_EQ(block_memory_bytes(store_of_blocks(), {GL_COMPRESSED_RGBA_BPTC_UNORM, {0, 5, 2, 3}}), 0u);
}

TEST(BlockStore, CountsInBlocks) {
    glapi::PixelStore store = store_of_blocks();
    store.row_length = 13, store.image_height = 12;  // 4 x 3 blocks
    store.skip_pixels = 4, store.skip_rows = 8, store.skip_images = 1;
    EXPECT_EQ(block_slice_offset(store, kVolume, 0), (12u + 8 + 1) * 16);
    EXPECT_EQ(block_slice_offset(store, kVolume, 1), (24u + 8 + 1) * 16);
    EXPECT_EQ(block_memory_bytes(store, kVolume), (24u + 8 + 1 + 4 + 2) * 16);
    EXPECT_EQ(block_slice_offset(store, {kVolume.format, {8, 5, 1, 2}}, 0), (8u + 1) * 16) << "no images are skipped";
    store.block_depth = 0;
    EXPECT_EQ(block_slice_offset(store, kVolume, 0), (8u + 1) * 16);
    store.block_height = 0;
    EXPECT_EQ(block_slice_offset(store, kVolume, 1), (2u * 4 + 1) * 16) << "nor rows";
}

TEST(BlockStore, BlocksHaveSizesOfTheirOwn) {
    const BlockImage image{GL_COMPRESSED_RGBA_ASTC_10x5_KHR, {21, 6, 1, 2}};  // 3 x 2 blocks
    EXPECT_EQ(block_memory_bytes({}, image), 6u * 16);
    glapi::PixelStore store = store_of_blocks();
    store.block_width = 10, store.block_height = 5, store.row_length = 40;
    EXPECT_EQ(block_memory_bytes(store, image), (4u + 3) * 16);
}

TEST(BlockStore, SkipsWholeBlocksOnly) {
    glapi::PixelStore store = store_of_blocks();
    store.block_depth = 2;
    store.skip_images = 1;
    EXPECT_EQ(block_store_error(store, 2), GLenum{GL_NO_ERROR});
    EXPECT_EQ(block_store_error(store, 3), GLenum{GL_INVALID_OPERATION});
    store.skip_rows = 2;
    EXPECT_EQ(block_store_error(store, 1), GLenum{GL_NO_ERROR});
    EXPECT_EQ(block_store_error(store, 2), GLenum{GL_INVALID_OPERATION});
    store.skip_pixels = 5;
    EXPECT_EQ(block_store_error(store, 1), GLenum{GL_INVALID_OPERATION});
    store.block_bytes = 0;
    EXPECT_EQ(block_store_error(store, 3), GLenum{GL_NO_ERROR});
}

TEST(BlockStore, GoesThereAndBack) {
    glapi::PixelStore store = store_of_blocks();
    store.row_length = 12, store.image_height = 12, store.skip_pixels = 4;
    std::vector<std::byte> tight(8 * 16);
    for (std::size_t i = 0; i < tight.size(); ++i) tight[i] = static_cast<std::byte>(i + 1);
    std::vector<std::byte> memory(block_memory_bytes(store, kVolume));
    pack_blocks(store, kVolume, tight, memory.data());
    EXPECT_EQ(memory[15], std::byte{0});
    EXPECT_EQ(memory[16], std::byte{1});
    EXPECT_EQ(memory[3 * 16], std::byte{0}) << "behind the row";
    EXPECT_EQ(memory[4 * 16], tight[2 * 16]);
    EXPECT_EQ(memory[10 * 16], tight[4 * 16]) << "the second slice";
    EXPECT_EQ(unpack_blocks(store, kVolume, memory.data()), tight);
}

}  // namespace
}  // namespace wall::client
