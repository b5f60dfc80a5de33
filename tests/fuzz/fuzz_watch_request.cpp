// SPDX-License-Identifier: MIT
// What a viewer asks for is refused with a sentence, or becomes parts that lie in its picture and in their tiles.
#include "common/config/load_config.h"
#include "tests/support/small_wall.h"
#include "walld/streams/stream_scope.h"

namespace {

using namespace wall;
using namespace wall::walld;

constexpr const char* kConfig =
    "[[node]]\nname = \"n\"\n"
    "[[node.tile]]\nname = \"a\"\nrect = [0, 0, 640, 480]\n"
    "[[node.tile]]\nname = \"b\"\nrect = [701, 13, 333, 271]\n";

bool inside(const geom::Rect& part, const geom::Rect& whole) {
    return !part.empty() && geom::intersect(part, whole) == part;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static NoOutbox out;
    static const Wall wall(*config::parse_config(kConfig, "fuzz"), out,
                           [](std::size_t n) { return std::string(n, 'x'); });
    const auto requests = WatchRequest::parse({reinterpret_cast<const char*>(data), size});
    if (!requests && requests.error().message.empty()) __builtin_trap();
    if (!requests) return 0;
    for (const auto& request : *requests) {
        const auto scope = scope_of(wall, request);
        if (!scope) continue;
        const geom::Rect picture{0, 0, static_cast<std::int32_t>(scope->width),
                                 static_cast<std::int32_t>(scope->height)};
        for (const auto& part : parts_of(wall, *scope)) {
            const auto& tile = wall.nodes()[part.node].config->tiles[part.slot].rect;
            if (!inside(part.at, picture) || !inside(part.crop, {0, 0, tile.width, tile.height})) __builtin_trap();
            if (part.at.width > part.crop.width || part.at.height > part.crop.height) __builtin_trap();
        }
    }
    return 0;
}
