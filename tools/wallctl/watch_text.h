// SPDX-License-Identifier: MIT
// What `wallctl watch` shows: a status of walld with rates from the one before, as JSON and as text. Pure.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace wall::wallctl {

/// `now` with "frames_per_second" in tiles, surfaces and streams, and "bytes_per_second" in streams, where the one
/// before (null: none) knows them too. `seconds`: between the two.
nlohmann::json with_rates(const nlohmann::json& before, nlohmann::json now, double seconds);

struct Screen {
    std::size_t columns, rows;  ///< cells; kAnyWidth: as many as it takes
};

/// The view, lines that fit the screen. `note`: for the first line, such as the time.
std::string watch_text(const nlohmann::json& rated, const std::string& note, const Screen& screen);

}  // namespace wall::wallctl
