// SPDX-License-Identifier: MIT
// The uniforms that hold a program's camera, as whoever starts it names them (docs/walls.md, "Views"). Pure.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wall {

inline constexpr std::size_t kMostCameraNames = 16, kMostCameraName = 256;  ///< of a program; bytes

/// What names of uniforms in GLSL are made of: identifiers, members, elements.
inline bool is_uniform_name(std::string_view text) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
               c == '[' || c == ']';
    };
    return !text.empty() && text.size() <= kMostCameraName && std::ranges::all_of(text, fits);
}

/// Names as in the shaders, such as "camera.projection" or "matrices[1]", with commas between them. Nothing: one is no
/// name, or there are too many.
inline std::optional<std::vector<std::string>> camera_names_of_text(std::string_view text) {
    std::vector<std::string> out;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        const std::string_view name = text.substr(at, end - at);
        if (!is_uniform_name(name) || out.size() == kMostCameraNames) return std::nullopt;
        out.emplace_back(name);
        at = end + 1;
    }
    return out;
}

}  // namespace wall
