// SPDX-License-Identifier: MIT
#include "common/base/quoted.h"

namespace wall {
namespace {

constexpr char kHexDigits[] = "0123456789abcdef";

void append(std::string& out, char c) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += {'\\', c};
    else if (c == '\n') out += "\\n";
    else if (c == '\t') out += "\\t";
    else if (byte < 0x20 || byte > 0x7e) out += {'\\', 'x', kHexDigits[byte >> 4], kHexDigits[byte & 0xf]};
    else out += c;
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text.substr(0, kMaxQuoted)) append(out, c);
    if (text.size() > kMaxQuoted) out += "...";
    return out;
}

std::string in_quotes(std::string_view text) { return '"' + escaped(text) + '"'; }

}  // namespace wall
