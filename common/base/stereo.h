// SPDX-License-Identifier: MIT
// How the two pictures of a window are apart that its person's eyes see (docs/walls.md, "Stereo"). Pure.
#pragma once

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

namespace wall {

struct Stereo {
    float separation = 0;  ///< of what is infinitely far: a share of the window's width; less than 0: eyes are swapped
    float screen = 0;      ///< the program's units: at this distance they are one. 0: to be measured
    bool operator==(const Stereo&) const = default;
};

inline constexpr double kUsualSeparation = 0.015, kMostSeparation = 0.25;  ///< shares of a window's width
inline constexpr double kFarthestScreen = 1e9;                             ///< the program's units

inline bool is_sound(const Stereo& stereo) {
    return std::abs(static_cast<double>(stereo.separation)) <= kMostSeparation && stereo.screen >= 0 &&
           static_cast<double>(stereo.screen) <= kFarthestScreen;
}

/// "PERCENT" of the window's width or "PERCENT,DISTANCE", as people say it. Nothing: it is neither.
inline std::optional<Stereo> stereo_of_text(const std::string& text) {
    double percent = 0, distance = 0;
    char extra = 0;
    const bool alone = std::sscanf(text.c_str(), "%lf%c", &percent, &extra) == 1;
    if (!alone && std::sscanf(text.c_str(), "%lf,%lf%c", &percent, &distance, &extra) != 2) return std::nullopt;
    const Stereo out{static_cast<float>(percent / 100), static_cast<float>(distance)};
    return is_sound(out) ? std::optional(out) : std::nullopt;
}

}  // namespace wall
