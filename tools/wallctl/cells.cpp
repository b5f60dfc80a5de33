// SPDX-License-Identifier: MIT
#include "tools/wallctl/cells.h"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "tools/wallctl/columns.h"

namespace wall::wallctl {

using nlohmann::json;

namespace {

constexpr double kFewer = 1.2;  // so many times fewer bytes go out than were packed: they are coded

}  // namespace

std::string text(const json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || found->is_null()) return "";
    return found->is_string() ? printable(found->get<std::string>()) : found->dump();
}

bool is(const json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_boolean() && found->get<bool>();
}

std::string place(const json& object) {
    const auto rect = object.value("rect", std::vector<int>(4));
    return rect.size() == 4 ? fmt::format("{}x{}+{}+{}", rect[2], rect[3], rect[0], rect[1]) : "";
}

std::string who(const json& person) {
    const auto kind = text(person, "kind");
    if (kind == "unknown") return "unknown";
    return kind == "token" ? "token " + text(person, "name") : text(person, "name");
}

std::string per_second(double bytes) {
    return bytes < 1e6 ? fmt::format("{:.1f} kB/s", bytes / 1e3) : fmt::format("{:.1f} MB/s", bytes / 1e6);
}

std::string traffic(const json& session) {
    const auto of = session.value("traffic", json::object());
    if (of.value("frames", 0) == 0 && of.value("geometry_bytes", 0) == 0) return "";
    const double packed = of.value("state_bytes_per_second", 0.0) + of.value("object_bytes_per_second", 0.0) +
                          of.value("geometry_bytes_per_second", 0.0);
    const double link = of.value("link_bytes_per_second", 0.0);
    const bool is_coded = link > 0 && kFewer * link < packed;
    return is_coded ? fmt::format("{} as {}", per_second(packed), per_second(link)) : per_second(packed);
}

}  // namespace wall::wallctl
