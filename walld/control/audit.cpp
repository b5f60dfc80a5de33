// SPDX-License-Identifier: MIT
#include "walld/control/audit.h"

#include <nlohmann/json.hpp>

#include "common/log/quoted.h"

namespace wall::walld {
namespace {

using nlohmann::json;

/// As JSON, which is pure ASCII in one line.
std::string one_line(const json& value) {
    const auto text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() <= kMaxQuoted ? text : "\"too long\"";
}

log::Quoted target_of(const json& arguments) {
    for (const char* key : {"id", "name"}) {
        const auto found = arguments.find(key);
        if (found != arguments.end())
            return log::quoted(found->is_string() ? found->get_ref<const std::string&>() : one_line(*found));
    }
    return log::quoted("");
}

}  // namespace

std::string audit_line(const Deed& deed) {
    auto out = fmt::format("audit who={} role={} via={} what={} target={} arguments={}", log::quoted(deed.who.text()),
                           config::name_of(deed.who.role), deed.via, deed.what, target_of(deed.arguments),
                           one_line(deed.arguments));
    if (!deed.refusal) return out + " result=ok";
    return out + fmt::format(" result={} reason={}", name_of(deed.refusal->kind), log::quoted(deed.refusal->message));
}

}  // namespace wall::walld
