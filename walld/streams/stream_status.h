// SPDX-License-Identifier: MIT
// What is watched, as JSON (docs/http-api.md). Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "walld/streams/stream_hub.h"

namespace wall::walld {

/// `streams`: as StreamHub::views() gives them.
nlohmann::json streams_json(const Wall& wall, const std::vector<StreamView>& streams);

}  // namespace wall::walld
