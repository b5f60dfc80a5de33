// SPDX-License-Identifier: MIT
#include "walld/audit.h"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

namespace wall::walld {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxText = 512;  // bytes

/// Pure ASCII, in one line.
std::string one_line(const json& value) {
    const auto text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() <= kMaxText ? text : "\"too long\"";
}

std::string target_of(const json& arguments) {
    for (const char* key : {"id", "name"}) {
        const auto found = arguments.find(key);
        if (found != arguments.end()) return found->is_string() ? one_line(*found) : one_line(found->dump());
    }
    return "\"\"";
}

}  // namespace

std::string audit_line(const Deed& deed) {
    auto out = fmt::format("audit who={} role={} via={} what={} target={} arguments={}", one_line(deed.who.text()),
                           config::name_of(deed.who.role), deed.via, deed.what, target_of(deed.arguments),
                           one_line(deed.arguments));
    if (!deed.refusal) return out + " result=ok";
    return out + fmt::format(" result={} reason={}", name_of(deed.refusal->kind), one_line(deed.refusal->message));
}

}  // namespace wall::walld
