// SPDX-License-Identifier: MIT
#include "tools/wallctl/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/wallctl/cells.h"

namespace wall::wallctl {
namespace {

using nlohmann::json;
using Findings = std::vector<Finding>;

constexpr std::int64_t kClockDifference = 2000;      // ms; less may be what the answer took
constexpr unsigned kManyStarts = 3;                  // of a node, while walld runs
constexpr unsigned kFarBehind = 30;                  // frames that a tile lacks
constexpr unsigned kEnoughFrames = 100;              // of a window, to judge by
constexpr double kManyTimeouts = 0.01;               // of its frames
constexpr double kNearlyFull = 0.9;                  // of the programs that there may be
constexpr double kHalfAGigabit = 62.5e6;             // bytes a second
constexpr double kLargeTexture = 2048 * 2048 * 4.0;  // bytes
constexpr std::size_t kNamedDrivers = 60;            // characters

const json& list(const json& status, const char* name) {
    static const json none = json::array();
    const auto found = status.find(name);
    return found != status.end() && found->is_array() ? *found : none;
}

std::uint64_t number(const json& of, const char* name) {
    const auto found = of.find(name);
    const bool counts = found != of.end() && found->is_number_integer() && *found >= 0;
    return counts ? found->get<std::uint64_t>() : 0;
}

/// Mesa's renderers without a GPU say so by these names.
bool draws_in_software(const json& node) {
    const auto renderer = text(node, "renderer");
    return std::ranges::any_of(std::initializer_list<std::string_view>{"llvmpipe", "softpipe", "swrast"},
                               [&](auto name) { return renderer.find(name) != std::string::npos; });
}

Finding node_finding(const json& node) {
    const auto name = text(node, "name");
    const auto check = "node " + name;
    if (is(node, "drained"))
        return {check, Verdict::note, "is drained: `wallctl node undrain " + name + "` brings it back"};
    if (!is(node, "up"))
        return {check, Verdict::wrong,
                "is away: systemctl status tileserver@" + name + " (tileserver-joined@" + name +
                    " on a machine that has joined), or start tileserver --node " + name};
    if (is(node, "silent"))
        return {check, Verdict::wrong,
                "nothing has been heard of it for two seconds: its machine or the link may be dead"};
    if (const auto starts = number(node, "incarnation"); starts >= kManyStarts)
        return {check, Verdict::note,
                fmt::format("has been started {} times since walld was: journalctl -u tileserver@{} says why", starts,
                            name)};
    return {check, Verdict::good, text(node, "renderer")};
}

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

/// All nodes alike draw alike, and as fast.
void add_drivers(Findings& out, const json& nodes) {
    std::map<std::string, std::vector<std::string>> drivers;
    std::vector<std::string> software, hardware;
    for (const auto& node : nodes) {
        if (!is(node, "up")) continue;
        drivers[text(node, "renderer") + ", " + text(node, "version")].push_back(text(node, "name"));
        (draws_in_software(node) ? software : hardware).push_back(text(node, "name"));
    }
    if (!software.empty())
        out.push_back({"GPUs", Verdict::note,
                       hardware.empty() ? "no node has one: all draw in software"
                                        : joined(software) + " draw in software, beside GPUs in " + joined(hardware) +
                                              ": the others' frames wait for them"});
    if (drivers.size() < 2) return;
    std::vector<std::string> named;
    for (const auto& [driver, names] : drivers) named.push_back(joined(names) + ": " + driver.substr(0, kNamedDrivers));
    out.push_back({"drivers", Verdict::note,
                   "differ, so programs get what all of them can do, and tiles may differ by a rounding: " +
                       fmt::format("{}", fmt::join(named, "; "))});
}

void add_tiles(Findings& out, const json& tiles) {
    std::vector<std::string> late;
    for (const auto& tile : tiles)
        if (is(tile, "up") && number(tile, "lag_frames") >= kFarBehind)
            late.push_back(fmt::format("{} ({} frames)", text(tile, "name"), number(tile, "lag_frames")));
    if (!late.empty())
        out.push_back({"tiles", Verdict::wrong,
                       "are behind what the wall shows: " + joined(late) + ": their nodes are too slow"});
}

void add_window(Findings& out, const json& window) {
    const auto frames = number(window, "frame"), missed = number(window, "swap_timeouts");
    if (frames < kEnoughFrames || static_cast<double>(missed) < kManyTimeouts * static_cast<double>(frames)) return;
    out.push_back(
        {"window " + text(window, "id"), Verdict::note,
         fmt::format("{} of its {} frames did not wait for a slow node: `wallctl tiles` shows which is behind", missed,
                     frames)});
}

void add_session(Findings& out, const json& session) {
    const auto check = fmt::format("session {}", number(session, "id"));
    if (const auto fault = text(session, "fault"); !fault.empty()) out.push_back({check, Verdict::wrong, fault});
    if (is(session, "silent"))
        out.push_back({check, Verdict::note, "its program says nothing: is it stopped, or its link dead?"});
    if (is(session, "held"))
        out.push_back(
            {check, Verdict::note, "is held: it shows no frame until `wallctl step`, or `wallctl hold --off`"});
    for (const auto& window : list(session, "surfaces")) add_window(out, window);
}

void add_fullness(Findings& out, const json& status) {
    const auto wall = status.find("wall");
    if (wall == status.end() || !wall->is_object()) return;
    const auto most = number(*wall, "max_sessions");
    const auto there = list(status, "sessions").size();
    if (most != 0 && static_cast<double>(there) >= kNearlyFull * static_cast<double>(most))
        out.push_back({"room", Verdict::note,
                       fmt::format("{} of {} programs are on the wall ('max_sessions' in [wall])", there, most)});
}

}  // namespace

std::vector<Finding> clock_findings(const std::string& whose, std::int64_t ahead_ms) {
    if (ahead_ms > -kClockDifference && ahead_ms < kClockDifference) return {};
    return {{"clock of " + whose, Verdict::note,
             fmt::format("is {:.1f} s {} walld's, so logs and the ages of pictures do not agree: `timedatectl set-ntp "
                         "true` there",
                         static_cast<double>(std::abs(ahead_ms)) / 1000, ahead_ms > 0 ? "ahead of" : "behind")}};
}

Finding way_finding(const Way& way, const json& status) {
    std::string check = "bandwidth to tile " + way.tile;
    for (const auto& tile : list(status, "tiles"))
        if (text(tile, "name") == way.tile) check = "bandwidth to node " + text(tile, "node");
    if (!way.trouble.empty()) return {check, Verdict::wrong, way.trouble};
    auto found = fmt::format("{:.1f} MB/s, {:.2f} ms there and back", way.bytes_a_second / 1e6,
                             static_cast<double>(way.round_trip.count()) / 1e3);
    if (way.bytes_a_second >= kHalfAGigabit) return {check, Verdict::good, std::move(found)};
    return {check, Verdict::note,
            fmt::format("{}: less than half of what a gigabit link carries; a texture of 2048x2048 takes {:.1f} s. Is "
                        "something between at 100 Mbit/s, a radio, or busy ([quota] in wall.toml limits, too)?",
                        found, kLargeTexture / way.bytes_a_second)};
}

std::vector<Finding> diagnose(const json& status) {
    Findings out;
    if (!status.is_object()) return {{"walld's answer", Verdict::wrong, "no status that is understood"}};
    for (const auto& node : list(status, "nodes")) {
        out.push_back(node_finding(node));
        const auto ahead = node.find("clock_ahead_ms");
        if (ahead == node.end() || !ahead->is_number_integer()) continue;
        for (auto& finding : clock_findings("node " + text(node, "name"), ahead->get<std::int64_t>()))
            out.push_back(std::move(finding));
    }
    add_drivers(out, list(status, "nodes"));
    add_tiles(out, list(status, "tiles"));
    for (const auto& session : list(status, "sessions")) add_session(out, session);
    add_fullness(out, status);
    return out;
}

}  // namespace wall::wallctl
