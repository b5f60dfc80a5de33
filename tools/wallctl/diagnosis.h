// SPDX-License-Identifier: MIT
// What a wall's status says about what people complain of: a dark tile, a slow program, another picture than yesterday.
// Pure.
#pragma once

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

/// `status`: as walld answers it (docs/http-api.md).
std::vector<Finding> diagnose(const nlohmann::json& status);

}  // namespace wall::wallctl
