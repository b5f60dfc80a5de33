// SPDX-License-Identifier: MIT
// What a program and a person may have of the wall at once ([quota] in wall.toml). Pure; any thread.
#pragma once

#include <cstdint>
#include <optional>

namespace wall::config {

/// Nothing: as much as there is.
struct QuotaConfig {
    std::optional<std::uint64_t> program_memory;     ///< bytes on a node, of a program's objects
    std::optional<std::uint32_t> program_objects;    ///< on a node
    std::optional<std::uint64_t> program_bandwidth;  ///< bytes a second, into a node
    std::optional<std::uint32_t> program_fps;        ///< frames a second of a window
    std::optional<std::uint32_t> program_windows;
    std::optional<std::uint32_t> person_programs;
    std::optional<std::uint64_t> person_memory;    ///< bytes on a node, of all of their programs' objects
    std::optional<std::uint32_t> person_views;     ///< live pictures that are watched or recorded
    std::optional<std::uint32_t> person_pictures;  ///< single ones that are being made
    bool operator==(const QuotaConfig&) const = default;
};

}  // namespace wall::config
