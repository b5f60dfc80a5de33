// SPDX-License-Identifier: MIT
#include "tools/wallctl/doctor.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "common/json/parse_json.h"
#include "tools/wallrun/launch.h"

namespace wall::wallctl {
namespace {

Finding from(std::string check, const Result<void>& result, std::string detail) {
    return {std::move(check), result.has_value(), result ? std::move(detail) : result.error().message};
}

Finding vendor_finding(const std::string& tool) {
    const auto files = wallrun::find_vendor(tool);
    if (!files) return {"vendor libraries", false, files.error().message};
    return from("vendor libraries", wallrun::check_vendor(*files), files->folder);
}

void add_wall(std::vector<Finding>& out, const std::string& status_json) {
    const auto parsed = parse_json(status_json, kAnswerJson);
    if (!parsed || !parsed->is_object())
        return out.push_back({"walld's answer", false, "no status that is understood"});
    const auto& status = *parsed;
    for (const auto& node : status.value("nodes", nlohmann::json::array())) {
        const bool up = node.value("up", false);
        out.push_back({"node " + node.value("name", ""), up,
                       up ? node.value("renderer", "") : "is away: start tileserver --node " + node.value("name", "")});
    }
    for (const auto& session : status.value("sessions", nlohmann::json::array())) {
        const auto fault = session.value("fault", "");
        if (!fault.empty()) out.push_back({"session " + std::to_string(session.value("id", 0)), false, fault});
    }
}

}  // namespace

std::vector<Finding> examine(const std::string& walld, const std::string& tool) {
    std::vector<Finding> out{vendor_finding(tool)};
    const char* display = std::getenv("DISPLAY");
    out.push_back(
        {"X display", display && *display,
         display && *display ? display : "DISPLAY is not set: programs need one for their windows (Xvfb will do)"});
    std::string status;
    out.push_back(from("walld", wallrun::check_walld(walld, &status), walld));
    if (!status.empty()) add_wall(out, status);
    return out;
}

}  // namespace wall::wallctl
