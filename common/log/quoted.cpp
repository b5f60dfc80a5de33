// SPDX-License-Identifier: MIT
#include "common/log/quoted.h"

#include <algorithm>

namespace wall::log {
namespace {

void append(std::string& out, char c) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') out += {'\\', c};
    else if (c == '\n') out += "\\n";
    else if (c == '\t') out += "\\t";
    else if (byte < 0x20 || byte > 0x7e) out += fmt::format("\\x{:02x}", byte);
    else out += c;
}

}  // namespace

Quoted quoted(std::string_view text) {
    Quoted out{"\""};
    for (const char c : text.substr(0, kMaxText)) append(out.text, c);
    out.text += text.size() > kMaxText ? "...\"" : "\"";
    return out;
}

}  // namespace wall::log
