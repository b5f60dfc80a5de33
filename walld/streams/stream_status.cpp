// SPDX-License-Identifier: MIT
#include "walld/streams/stream_status.h"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

namespace wall::walld {
namespace {

using nlohmann::json;

json one(const Wall& wall, const StreamView& stream) {
    json out{{"node", wall.nodes()[stream.node].config->name},
             {"tile", stream.tile},
             {"codec", stream.codec},
             {"width", stream.width},
             {"height", stream.height},
             {"fps", stream.fps},
             {"viewers", stream.viewers},
             {"frames", stream.frames},
             {"bytes", stream.bytes},
             {"dropped", stream.dropped},
             {"region", nullptr},
             {"output", stream.output},
             {"session", nullptr}};
    if (!stream.crop.empty()) out["region"] = {stream.crop.x, stream.crop.y, stream.crop.width, stream.crop.height};
    if (stream.session)
        out["session"] = stream.surface ? fmt::format("{}.{}", stream.session.value, stream.surface.value)
                                        : std::to_string(stream.session.value);
    return out;
}

}  // namespace

json streams_json(const Wall& wall, const std::vector<StreamView>& streams) {
    auto out = json::array();
    for (const auto& stream : streams) out.push_back(one(wall, stream));
    return out;
}

}  // namespace wall::walld
