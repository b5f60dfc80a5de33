// SPDX-License-Identifier: MIT
#include "tools/wallplay/info.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "gen/glapi/wire.gen.h"

namespace wall::wallplay {
namespace {

double seconds_of(recording::Time time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

nlohmann::json info_json(const recording::Reader& reader, std::uint64_t bytes) {
    const auto& [stream, started, program, creator] = reader.header();
    const auto& index = reader.index();
    const auto since_epoch = std::chrono::duration_cast<std::chrono::seconds>(started);
    auto segments = nlohmann::json::array(), windows = nlohmann::json::array();
    for (const auto& segment : index.segments)
        segments.push_back(
            {{"seconds", seconds_of(segment.time)}, {"frame", segment.frame}, {"offset", segment.offset}});
    for (const auto& window : index.windows) windows.push_back({{"width", window.width}, {"height", window.height}});
    nlohmann::json out{
        {"program", program},
        {"creator", creator},
        {"started", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(since_epoch.count())))},
        {"stream", fmt::format("{:08x}", stream)},
        {"playable", stream == glapi::kStreamVersion},
        {"seconds", seconds_of(index.duration)},
        {"frames", index.frames},
        {"bytes", bytes},
        {"plain_bytes", index.batch_bytes},
        {"segments", std::move(segments)},
        {"windows", std::move(windows)}};
    if (reader.recovered()) out["recovered"] = *reader.recovered();
    return out;
}

std::string info_text(const nlohmann::json& info) {
    std::string out = fmt::format("program   {}\nrecorded  {} by {}\nlength    {:.1f} s, {} frames\n",
                                  info["program"].get<std::string>(), info["started"].get<std::string>(),
                                  info["creator"].get<std::string>(), info["seconds"].get<double>(),
                                  info["frames"].get<std::uint64_t>());
    out += fmt::format("size      {:.2f} MB, of {:.2f} MB of commands\n", info["bytes"].get<double>() / 1e6,
                       info["plain_bytes"].get<double>() / 1e6);
    for (const auto& window : info["windows"])
        out += fmt::format("window    {}x{}\n", window["width"].get<std::uint32_t>(),
                           window["height"].get<std::uint32_t>());
    out += "begins at";
    for (const auto& segment : info["segments"]) out += fmt::format(" {:.1f}", segment["seconds"].get<double>());
    out += " s\n";
    if (info.contains("recovered")) out += "damaged   " + info["recovered"].get<std::string>() + "\n";
    if (!info["playable"].get<bool>())
        out += fmt::format("It cannot be played here: its stream version is {}, this one's is {:08x}.\n",
                           info["stream"].get<std::string>(), glapi::kStreamVersion);
    return out;
}

}  // namespace wall::wallplay
