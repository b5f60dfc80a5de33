// SPDX-License-Identifier: MIT
// walld's JSON as tables for people. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace wall::wallctl {

std::string nodes_table(const nlohmann::json& nodes);
std::string tiles_table(const nlohmann::json& tiles);
std::string sessions_table(const nlohmann::json& sessions);
std::string status_text(const nlohmann::json& status);

}  // namespace wall::wallctl
