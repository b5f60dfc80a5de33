// SPDX-License-Identifier: MIT
#include "client_lib/link/parallel.h"

#include <charconv>
#include <cstdlib>

#include "common/wire/limits.h"

namespace wall::client {
namespace {

bool read_number(std::string_view text, std::uint32_t& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

Result<Parallel> parse_parallel(std::string_view text) {
    const auto second = text.rfind(':');
    const auto first =
        second == std::string_view::npos || second == 0 ? std::string_view::npos : text.rfind(':', second - 1);
    Parallel out;
    const bool numbers = first != std::string_view::npos &&
                         read_number(text.substr(first + 1, second - first - 1), out.rank) &&
                         read_number(text.substr(second + 1), out.members);
    if (!numbers || first == 0 || out.members == 0 || out.members > wire::kMaxMembers || out.rank >= out.members)
        return fail("WALLGL_PARALLEL: expected GROUP:RANK:MEMBERS, ranks from 0, at most " +
                    std::to_string(wire::kMaxMembers) + " members, got '" + std::string(text) + "'");
    out.group = text.substr(0, first);
    return out;
}

const std::optional<Parallel>& parallel() {
    static const auto* read = [] {  // never destroyed: threads may outlive static destructors
        const char* value = secure_getenv("WALLGL_PARALLEL");
        const auto parsed = parse_parallel(value ? value : "");
        return new std::optional<Parallel>(parsed ? std::optional(*parsed) : std::nullopt);
    }();
    return *read;
}

}  // namespace wall::client
