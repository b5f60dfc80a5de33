// SPDX-License-Identifier: MIT
// Members of walld's objects as the text of a table's cells; empty where they are missing. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace wall::wallctl {

std::string text(const nlohmann::json& object, const char* key);
bool is(const nlohmann::json& object, const char* key);
/// The "rect" of a JSON object as WxH+X+Y.
std::string place(const nlohmann::json& object);
/// A user's name, or "token NAME".
std::string who(const nlohmann::json& person);
std::string per_second(double bytes);
/// Bytes a second to all nodes; empty before the program has said anything.
std::string traffic(const nlohmann::json& session);

}  // namespace wall::wallctl
