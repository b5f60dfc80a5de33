// SPDX-License-Identifier: MIT
// One request to walld and its answer. One thread.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "common/base/result.h"

namespace wall::wallctl {

struct Answer {
    nlohmann::json json;
    std::string blob;
};

Result<Answer> ask(const std::string& walld, const std::string& verb, const nlohmann::json& arguments, std::chrono::milliseconds limit);

}  // namespace wall::wallctl
