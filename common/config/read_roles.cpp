// SPDX-License-Identifier: MIT
#include "common/config/read_roles.h"

#include <string>

namespace wall::config {

Roles read_roles(TreeReader& read, const toml::table& table) {
    const auto* role = table.get("role");
    if (role == nullptr) return {};
    Roles out{.render = false, .display = false, .compose = false};
    const auto* array = role->as_array();
    for (std::size_t i = 0; i < (array ? array->size() : 1); ++i) {
        const auto& entry = array ? *array->get(i) : *role;
        const auto word = entry.value<std::string>().value_or("");
        if (word == "render") out.render = true;
        else if (word == "display") out.display = true;
        else if (word == "compose") out.compose = true;
        else
            read.refuse(entry.source(), "'role' is '" + word +
                                            "': expected \"render\", \"compose\" or \"display\", or several in a list");
    }
    if (out == Roles{.render = false, .display = false, .compose = false})
        read.refuse(role->source(), "'role' is empty: expected \"render\", \"compose\" or \"display\"");
    return out;
}

std::vector<const toml::table*> tile_tables(TreeReader& read, const toml::table& node) {
    if (node.get("tile") == nullptr && !read_roles(read, node).display) return {};
    return read.tables(node, "tile", "[[node.tile]]");
}

}  // namespace wall::config
