// SPDX-License-Identifier: MIT
// The wall as people and programs read it: JSON (docs/http-api.md). Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "walld/wall/wall.h"

namespace wall::walld {

nlohmann::json nodes_json(const Wall& wall);
nlohmann::json tiles_json(const Wall& wall, Clock::time_point now);
nlohmann::json sessions_json(const Wall& wall);
/// One session, which must exist.
nlohmann::json session_json(const Wall& wall, SessionId id);
nlohmann::json person_json(const Person& person);
/// All of the above, and the wall's own data.
nlohmann::json status_json(const Wall& wall, Clock::time_point now);
/// A status as text; what is not UTF-8 (programs name themselves) is replaced.
std::string dump(const nlohmann::json& value);

}  // namespace wall::walld
