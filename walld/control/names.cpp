// SPDX-License-Identifier: MIT
#include "walld/control/names.h"

#include <algorithm>

namespace wall::walld {

bool may_name_file(const std::string& name) {
    const auto good = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
               c == '.';
    };
    return !name.empty() && name.size() <= kMaxName && name[0] != '.' && std::ranges::all_of(name, good);
}

std::string file_name_rule() {
    return "1 to " + std::to_string(kMaxName) +
           " letters, digits, dots, dashes and underscores, and does not begin with a dot";
}

}  // namespace wall::walld
