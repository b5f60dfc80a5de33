// SPDX-License-Identifier: MIT
// From a TOML file's text to what it says. Any thread.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "common/config/tree_reader.h"

namespace wall::config {

/// `read_root` reads a file's root table.
template <class ReadRoot>
auto parse_toml(std::string_view toml, std::string_view file_name, ReadRoot read_root)
    -> Result<decltype(read_root(std::declval<TreeReader&>(), std::declval<const toml::table&>()))> {
    if (const auto line = control_character_line(toml)) {
        return fail(std::string(file_name) + ":" + std::to_string(line) +
                    ": not TOML: a control character: expected tabs and line breaks only");
    }
    const auto parsed = toml::parse(to_private_use(toml), file_name);
    TreeReader read(file_name);
    if (!parsed) {
        read.refuse(parsed.error().source(), "not TOML: " + std::string(parsed.error().description()));
        return tl::unexpected(*read.error());
    }
    auto out = read_root(read, parsed.table());
    if (read.error()) return tl::unexpected(*read.error());
    return out;
}

}  // namespace wall::config
