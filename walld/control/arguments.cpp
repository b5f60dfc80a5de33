// SPDX-License-Identifier: MIT
#include "walld/control/arguments.h"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace wall::walld {
namespace {

using nlohmann::json;

tl::unexpected<Refusal> expected(const char* key, const std::string& what) {
    return refuse(RefusalKind::invalid, "'" + std::string(key) + "': expected " + what);
}

/// Integers that JSON writes without a sign can exceed the signed ones.
std::optional<std::int64_t> integer(const json& value, std::int64_t least, std::int64_t most) {
    if (!value.is_number_integer() || (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX))
        return std::nullopt;
    const auto number = value.get<std::int64_t>();
    return number >= least && number <= most ? std::optional(number) : std::nullopt;
}

}  // namespace

Outcome<std::string> text_of(const json& arguments, const char* key) {
    const auto found = arguments.find(key);
    if (found == arguments.end()) return std::string();
    if (found->is_number_integer()) return found->dump();
    if (found->is_string()) return found->get<std::string>();
    return expected(key, "a string");
}

Outcome<std::int64_t> number_of(const json& arguments, const char* key, std::int64_t otherwise, std::int64_t least,
                                std::int64_t most) {
    const auto found = arguments.find(key);
    if (found == arguments.end()) return otherwise;
    if (const auto number = integer(*found, least, most)) return *number;
    return expected(key, "an integer from " + std::to_string(least) + " to " + std::to_string(most));
}

Outcome<double> real_of(const json& arguments, const char* key, double otherwise, double least, double most) {
    const auto found = arguments.find(key);
    if (found == arguments.end()) return otherwise;
    if (found->is_number() && found->get<double>() >= least && found->get<double>() <= most)
        return found->get<double>();
    std::array<char, 96> text{};
    (void)std::snprintf(text.data(), text.size(), "a number from %g to %g", least, most);
    return expected(key, text.data());
}

Outcome<bool> flag_of(const json& arguments, const char* key, bool otherwise) {
    const auto found = arguments.find(key);
    if (found == arguments.end()) return otherwise;
    if (found->is_boolean()) return found->get<bool>();
    return expected(key, "true or false");
}

Outcome<geom::Rect> rect_of(const json& arguments, const char* key) {
    constexpr const char* kRect = "[x, y, width, height] in canvas pixels";
    const auto found = arguments.find(key);
    if (found == arguments.end() || !found->is_array() || found->size() != 4) return expected(key, kRect);
    std::array<std::int32_t, 4> sides{};
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto side = integer((*found)[i], INT32_MIN, INT32_MAX);
        if (!side) return expected(key, kRect);
        sides[i] = static_cast<std::int32_t>(*side);
    }
    return geom::Rect{sides[0], sides[1], sides[2], sides[3]};
}

}  // namespace wall::walld
