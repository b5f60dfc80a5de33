// SPDX-License-Identifier: MIT
#include "common/config/toml_guard.h"

#include <cstddef>
#include <cstdint>

namespace wall::config {
namespace {

constexpr std::uint32_t kPrivateUse = 0x100000, kFirst = 0x80, kLast = 0xfeff;

struct Character {
    std::uint32_t code;
    std::size_t bytes;  ///< 0: ill-formed
};

/// The character of two bytes or more at the beginning (RFC 3629).
Character decode(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned lead = byte(0);
    const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0xc0 ? 2 : 0;
    if (bytes == 0 || lead > 0xf4 || text.size() < bytes) return {0, 0};
    std::uint32_t code = lead & (0x7fu >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {0, 0};
        code = code << 6 | (byte(i) & 0x3f);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < kLeast[bytes] || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff)) return {0, 0};
    return {code, bytes};
}

void encode(std::string& out, std::uint32_t code) {
    const auto tail = [&](unsigned shift) { out += static_cast<char>(0x80 | (code >> shift & 0x3f)); };
    if (code >= 0x10000) out += static_cast<char>(0xf0 | code >> 18), tail(12), tail(6), tail(0);
    else if (code >= 0x800) out += static_cast<char>(0xe0 | code >> 12), tail(6), tail(0);
    else out += static_cast<char>(0xc0 | code >> 6), tail(0);
}

std::string shifted(std::string_view text, std::uint32_t from, std::uint32_t to) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size();) {
        const auto [code, bytes] =
            static_cast<unsigned char>(text[i]) < 0x80 ? Character{0, 0} : decode(text.substr(i));
        if (bytes == 0) {
            out += text[i++];
            continue;
        }
        encode(out, code >= from + kFirst && code <= from + kLast ? code - from + to : code);
        i += bytes;
    }
    return out;
}

}  // namespace

std::uint32_t control_character_line(std::string_view text) {
    std::uint32_t line = 1;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte == 0x7f || (byte < 0x20 && c != '\t' && c != '\n' && c != '\r')) return line;
        line += c == '\n';
    }
    return 0;
}

std::string to_private_use(std::string_view utf8) { return shifted(utf8, 0, kPrivateUse); }
std::string from_private_use(std::string_view utf8) { return shifted(utf8, kPrivateUse, 0); }

}  // namespace wall::config
