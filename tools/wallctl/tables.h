// SPDX-License-Identifier: MIT
// walld's JSON as tables for people. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace wall::wallctl {

std::string nodes_table(const nlohmann::json& nodes);
std::string tiles_table(const nlohmann::json& tiles);
std::string sessions_table(const nlohmann::json& sessions);
std::string streams_table(const nlohmann::json& streams);
std::string status_text(const nlohmann::json& status);

std::string machines_table(const nlohmann::json& machines);
std::string tokens_table(const nlohmann::json& tokens);
/// What taking a token from somebody has ended.
std::string revoked_text(const nlohmann::json& revoked);
/// What to do on the machine that shall join.
std::string invitation_text(const nlohmann::json& invitation);

std::string person_text(const nlohmann::json& person);
std::string names_text(const nlohmann::json& names);
/// What reading wall.toml again has done.
std::string reloaded_text(const nlohmann::json& reloaded);
/// What loading a layout has done.
std::string placed_text(const nlohmann::json& loaded);

}  // namespace wall::wallctl
