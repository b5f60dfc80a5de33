// SPDX-License-Identifier: MIT
#include "tileserver/kms/edid.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

namespace wall::tileserver {
namespace {

constexpr std::size_t kBlock = 128;
constexpr std::array<std::uint8_t, 8> kBeginning = {0x00, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x00};
constexpr std::size_t kMaker =
    8;  // two bytes: three letters of 5 bits, A is 1; behind them the product, low byte first
constexpr std::size_t kDescriptors = 54, kDescriptorSize = 18, kDescriptorCount = 4;
constexpr std::array<std::uint8_t, 5> kNameFollows = {0, 0, 0, 0xfc, 0};

using Block = std::array<std::uint8_t, kBlock>;

std::string name_in(const Block& block) {
    for (std::size_t i = 0; i < kDescriptorCount; ++i) {
        const auto descriptor = std::span(block).subspan(kDescriptors + i * kDescriptorSize, kDescriptorSize);
        if (!std::ranges::equal(descriptor.first(kNameFollows.size()), kNameFollows)) continue;
        std::string out;
        for (const std::uint8_t c : descriptor.subspan(kNameFollows.size())) {
            if (c == '\n') break;
            out += c >= ' ' && c <= '~' ? static_cast<char>(c) : '?';
        }
        out.erase(out.find_last_not_of(' ') + 1);
        return out;
    }
    return {};
}

std::string number_in(const Block& block) {
    const unsigned maker = block[kMaker] * 256u + block[kMaker + 1];
    std::string out;
    for (const unsigned shift : {10u, 5u, 0u}) {
        const unsigned letter = maker >> shift & 31;
        out += letter >= 1 && letter <= 26 ? static_cast<char>('A' + letter - 1) : '?';
    }
    std::array<char, 8> product{};
    std::snprintf(product.data(), product.size(), " %04x", block[kMaker + 2] + block[kMaker + 3] * 256u);
    return out + product.data();
}

}  // namespace

std::string monitor_name(std::span<const std::byte> edid) {
    if (edid.size() < kBlock) return {};
    Block block{};
    std::ranges::transform(edid.first(kBlock), block.begin(),
                           [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
    unsigned sum = 0;
    for (const std::uint8_t b : block) sum += b;
    if (sum % 256 != 0 || !std::ranges::equal(std::span(block).first(kBeginning.size()), kBeginning)) return {};
    const auto name = name_in(block);
    return name.empty() ? number_in(block) : name;
}

}  // namespace wall::tileserver
