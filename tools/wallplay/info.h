// SPDX-License-Identifier: MIT
// What is in a recording, for people and as JSON. Pure.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "common/recording/reader.h"

namespace wall::wallplay {

/// {"program", "creator", "started", "stream", "playable", "seconds", "frames", "bytes", "plain_bytes", "segments":
/// [{"seconds", "frame", "offset"}], "windows": [{"width", "height"}], "recovered"}; `bytes`: of the file.
nlohmann::json info_json(const recording::Reader& reader, std::uint64_t bytes);
std::string info_text(const nlohmann::json& info);

}  // namespace wall::wallplay
