// SPDX-License-Identifier: MIT
#include "tools/wallctl/doctor.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/base/connect_within.h"
#include "common/base/unique_fd.h"
#include "common/join/membership.h"
#include "common/json/parse_json.h"
#include "tools/wallctl/x_display.h"
#include "tools/wallrun/launch.h"

namespace wall::wallctl {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kReach{1000}, kAnswer{5000};
constexpr const char* kStates = "/var/lib/wallgl";  // a folder for each way in which the machine has joined

Finding from(std::string check, const Result<void>& result, std::string detail) {
    return {std::move(check), result ? Verdict::good : Verdict::wrong,
            result ? std::move(detail) : result.error().message};
}

Finding vendor_finding(const std::string& tool) {
    const auto files = wallrun::find_vendor(tool);
    if (!files) return {"vendor libraries", Verdict::wrong, files.error().message};
    return from("vendor libraries", wallrun::check_vendor(*files), files->folder);
}

Finding display_finding() {
    const char* display = std::getenv("DISPLAY");
    if (!display || !*display)
        return {"X display", Verdict::wrong,
                "DISPLAY is not set: programs need one for their windows (Xvfb will do: xvfb-run wallrun ...)"};
    return from("X display", check_display(display), std::string(display) + ", with GLX");
}

/// Of those of this machine that one may see.
void add_keys(std::vector<Finding>& out) {
    std::error_code error;
    for (const auto& folder : fs::directory_iterator(kStates, error)) {
        const auto key = join::key_file(folder.path());
        const auto status = fs::status(key, error);
        if (error || !fs::exists(status)) continue;
        const auto name = "key in " + folder.path().string();
        const bool open = (status.permissions() & (fs::perms::group_all | fs::perms::others_all)) != fs::perms::none;
        if (open)
            out.push_back({name, Verdict::wrong, "others may read it: chmod 600 " + key.string() + ", and join anew"});
        else if (::access(key.c_str(), R_OK) != 0)
            out.push_back({name, Verdict::good, "is there, for its service alone"});
        else if (const auto joined = join::Membership::load(folder.path()); joined)
            out.push_back({name, Verdict::good, "is '" + joined->name + "' on the wall at " + joined->walld.text()});
        else out.push_back({name, Verdict::note, joined.error().message});
    }
}

Finding role_finding(const request::Walld& walld) {
    const auto answer = request::ask(walld, "whoami", nlohmann::json::object(), kAnswer);
    if (!answer) return {"role", Verdict::wrong, answer.error().message};
    const auto name = answer->json.value("name", ""), role = answer->json.value("role", "");
    if (role == "viewer")
        return {"role", Verdict::note,
                name + " is a viewer, who may not put programs on the wall: [people] in wall.toml"};
    return {"role", Verdict::good, name + ", " + role};
}

/// Programs of this machine go to the node themselves; to those of other machines an agent leads them.
void add_way(std::vector<Finding>& out, const nlohmann::json& node) {
    const auto address = Address::parse(node.value("address", ""));
    if (!node.value("up", false) || !address || !address->local()) return;
    const auto to = resolve(*address);
    if (!to) return out.push_back({"way to node " + node.value("name", ""), Verdict::wrong, to.error().message});
    const UniqueFd fd(::socket(to->family(), SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    const int failed = connect_within(fd.get(), to->get(), to->length, std::chrono::steady_clock::now() + kReach);
    out.push_back({"way to node " + node.value("name", ""), failed == 0 ? Verdict::good : Verdict::wrong,
                   failed == 0 ? address->text()
                               : address->text() + ": " + std::generic_category().message(failed) +
                                     ": programs cannot draw there"});
}

}  // namespace

std::vector<Finding> examine(const request::Walld& walld, const std::string& tool) {
    std::vector<Finding> out{vendor_finding(tool), display_finding()};
    add_keys(out);
    std::string status_text;
    out.push_back(from("walld", wallrun::check_walld(walld.address, &status_text), walld.address));
    if (status_text.empty()) return out;
    out.push_back(role_finding(walld));
    const auto status = parse_json(status_text, kAnswerJson);
    if (!status || !status->is_object()) {
        out.push_back({"walld's answer", Verdict::wrong, "no status that is understood"});
        return out;
    }
    if (const auto here = std::chrono::system_clock::now().time_since_epoch(); status->contains("time_ms"))
        for (auto& finding :
             clock_findings("this machine", std::chrono::duration_cast<std::chrono::milliseconds>(here).count() -
                                                status->value("time_ms", std::int64_t{0})))
            out.push_back(std::move(finding));
    for (const auto& node : status->value("nodes", nlohmann::json::array())) add_way(out, node);
    for (auto& finding : diagnose(*status)) out.push_back(std::move(finding));
    return out;
}

}  // namespace wall::wallctl
