// SPDX-License-Identifier: MIT
// Looks for what usually goes wrong, from the user's side. One thread.
#pragma once

#include <string>
#include <vector>

namespace wall::wallctl {

struct Finding {
    std::string check;
    bool good = false;
    std::string detail;  ///< what was found, or the remedy
};

std::vector<Finding> examine(const std::string& walld, const std::string& tool);

}  // namespace wall::wallctl
