// SPDX-License-Identifier: MIT
// Reads the JSON arguments of a verb; what is missing or of another kind is refused by name. Pure.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "common/geom/rect.h"
#include "walld/wall/refusal.h"

namespace wall::walld {

/// A string, or an integer as text; empty if absent.
Outcome<std::string> text_of(const nlohmann::json& arguments, const char* key);
/// `otherwise` if absent.
Outcome<std::int64_t> number_of(const nlohmann::json& arguments, const char* key, std::int64_t otherwise,
                                std::int64_t least, std::int64_t most);
Outcome<double> real_of(const nlohmann::json& arguments, const char* key, double otherwise, double least, double most);
Outcome<bool> flag_of(const nlohmann::json& arguments, const char* key, bool otherwise);
/// [x, y, width, height]
Outcome<geom::Rect> rect_of(const nlohmann::json& arguments, const char* key);

}  // namespace wall::walld
