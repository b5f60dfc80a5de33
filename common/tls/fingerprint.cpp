// SPDX-License-Identifier: MIT
#include "common/tls/fingerprint.h"

#include <algorithm>

namespace wall::tls {
namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
constexpr unsigned kBitsEach = 6, kByte = 8;

}  // namespace

std::string to_base64url(std::string_view bytes) {
    std::string out;
    std::uint32_t held = 0;
    unsigned bits = 0;
    for (const char c : bytes) {
        held = held << kByte | static_cast<std::uint8_t>(c);
        for (bits += kByte; bits >= kBitsEach; bits -= kBitsEach) out += kAlphabet[held >> (bits - kBitsEach) & 63];
    }
    if (bits > 0) out += kAlphabet[held << (kBitsEach - bits) & 63];
    return out;
}

Result<std::string> from_base64url(std::string_view text) {
    std::string out;
    std::uint32_t held = 0;
    unsigned bits = 0;
    for (const char c : text) {
        const auto digit = kAlphabet.find(c);
        if (digit == std::string_view::npos) return fail("expected letters, digits, '-' and '_' only");
        held = held << kBitsEach | static_cast<std::uint32_t>(digit);
        bits += kBitsEach;
        if (bits < kByte) continue;
        bits -= kByte;
        out += static_cast<char>(held >> bits & 255);
    }
    if (to_base64url(out) != text) return fail("cut off, or changed");
    return out;
}

Result<Fingerprint> Fingerprint::parse(std::string_view text) {
    const auto bytes = text.size() == kCharacters ? from_base64url(text) : Result<std::string>(std::string());
    if (!bytes || bytes->size() != kBytes)
        return fail("expected a fingerprint, " + std::to_string(kCharacters) + " letters, digits, '-' and '_'");
    return from_bytes(*bytes);
}

Result<Fingerprint> Fingerprint::from_bytes(std::string_view bytes) {
    if (bytes.size() != kBytes) return fail("expected a fingerprint of " + std::to_string(kBytes) + " bytes");
    Fingerprint out;
    std::ranges::copy(bytes, out.value_.begin());
    return out;
}

std::string Fingerprint::text() const { return to_base64url(bytes()); }

std::string Fingerprint::bytes() const { return {value_.begin(), value_.end()}; }

}  // namespace wall::tls
