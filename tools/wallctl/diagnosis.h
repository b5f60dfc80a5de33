// SPDX-License-Identifier: MIT
// What a wall's status says about what people complain of: a dark tile, a slow program, another picture than yesterday.
// Pure.
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace wall::wallctl {

enum class Verdict { good, note, wrong };  ///< note: it may be wanted so, and explains something

struct Finding {
    std::string check;
    Verdict verdict = Verdict::good;
    std::string detail;  ///< what was found; the remedy, where there is one
};

/// How far a machine's clock is ahead of walld's; nothing if that is little enough.
std::vector<Finding> clock_findings(const std::string& whose, std::int64_t ahead_ms);

/// From this machine to a node, as programs take it.
struct Way {
    std::string tile;                        ///< one of the node's
    double bytes_a_second = 0;               ///< until the node has taken them, its driver included
    std::chrono::microseconds round_trip{};  ///< the median of some
    std::string trouble;                     ///< why it could not be measured; then the rest means nothing
};
/// `status`: names the tile's node.
Finding way_finding(const Way& way, const nlohmann::json& status);

/// `status`: as walld answers it (docs/http-api.md).
std::vector<Finding> diagnose(const nlohmann::json& status);

}  // namespace wall::wallctl
