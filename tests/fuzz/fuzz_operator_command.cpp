// SPDX-License-Identifier: MIT
// An operator's arguments are refused with a sentence, or are JSON that walld can write and read again; whatever they
// are, the log gets one line of printable ASCII.
#include <algorithm>

#include "common/json/parse_json.h"
#include "walld/control/arguments.h"
#include "walld/control/audit.h"

namespace {

using namespace wall;
using namespace wall::walld;

bool one_line(const std::string& text) {
    return std::ranges::all_of(text, [](unsigned char c) { return c >= 0x20 && c <= 0x7e; });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto arguments = parse_json(text, kRequestJson);
    if (!arguments && arguments.error().message.empty()) __builtin_trap();
    if (!arguments || !arguments->is_object()) return 0;
    const auto again = parse_json(arguments->dump(), {2 * kRequestJson.bytes, kRequestJson.depth});
    if (again && *again != *arguments) __builtin_trap();
    static_cast<void>(rect_of(*arguments, "rect"));
    static_cast<void>(number_of(*arguments, "frame", 1, 1, INT32_MAX));
    static_cast<void>(flag_of(*arguments, "on", true));
    const auto id = text_of(*arguments, "id");
    const Person who{Person::Kind::unix_user, id ? *id : "somebody", 1, Role::user};
    const std::string verb = "place";
    const Refusal refusal{RefusalKind::invalid, std::string(text)};
    if (!one_line(audit_line({who, "control", verb, *arguments, &refusal}))) __builtin_trap();
    return 0;
}
