// SPDX-License-Identifier: MIT
#include "common/json/parse_json.h"

#include <string>

namespace wall {
namespace {

/// Whether brackets outside of strings nest deeper than `limit`. Of what is no JSON, a parser sees nothing deeper
/// before it notices.
bool deeper_than(std::size_t limit, std::string_view text) {
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            else if (c == '"') in_string = false;
            continue;
        }
        if (c == '"') in_string = true;
        else if ((c == '[' || c == '{') && ++depth > limit) return true;
        else if ((c == ']' || c == '}') && depth > 0) --depth;
    }
    return false;
}

}  // namespace

Result<nlohmann::json> parse_json(std::string_view text, const JsonLimits& limits) {
    if (text.size() > limits.bytes)
        return fail("JSON: expected at most " + std::to_string(limits.bytes) + " bytes, got " +
                    std::to_string(text.size()));
    if (deeper_than(limits.depth, text))
        return fail("JSON: expected at most " + std::to_string(limits.depth) + " arrays and objects in each other");
    auto out = nlohmann::json::parse(text, nullptr, false);
    if (out.is_discarded()) return fail("JSON: not well formed");
    return out;
}

}  // namespace wall
