// SPDX-License-Identifier: MIT
// Takes a fuzzer's input apart. What is asked for beyond its end is zero, or empty.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace wall::fuzz {

class InputPieces {
public:
    InputPieces(const std::uint8_t* data, std::size_t size) : rest_(reinterpret_cast<const char*>(data), size) {}

    bool empty() const { return rest_.empty(); }
    std::uint8_t byte() {
        const auto one = bytes(1);
        return one.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(one[0]);
    }
    std::string_view bytes(std::size_t count) {
        const auto taken = rest_.substr(0, count);
        rest_.remove_prefix(taken.size());
        return taken;
    }
    /// A length of two bytes, low first, and as many bytes.
    std::string_view counted() {
        const std::size_t low = byte(), high = byte();
        return bytes(low | high << 8);
    }

private:
    std::string_view rest_;
};

}  // namespace wall::fuzz
