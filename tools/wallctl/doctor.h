// SPDX-License-Identifier: MIT
// Looks for what usually goes wrong, from the user's side: this machine, the way to walld and the nodes, the wall. One
// thread; takes some seconds where nobody answers.
#pragma once

#include <string>
#include <vector>

#include "tools/request/request.h"
#include "tools/wallctl/diagnosis.h"

namespace wall::wallctl {

/// `tool`: this program's own path.
std::vector<Finding> examine(const request::Walld& walld, const std::string& tool);

}  // namespace wall::wallctl
