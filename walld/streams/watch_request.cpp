// SPDX-License-Identifier: MIT
#include "walld/streams/watch_request.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/codec/codec.h"
#include "common/json/parse_json.h"

namespace wall::walld {
namespace {

using nlohmann::json;

constexpr std::int32_t kFarthest = 32768;  // pixels, as in wall.toml

/// Reads members of an object until one is wrong; the first error stays.
class Members {
public:
    explicit Members(const json& from) : from_(from) {}

    const std::string& error() const { return error_; }
    bool has(const char* key) const { return from_.contains(key); }
    void refuse(const char* key, const std::string& expected) {
        if (error_.empty()) error_ = std::string(".") + key + ": expected " + expected;
    }
    /// An integer from `least` to `most`, `otherwise` if it is not there.
    std::uint32_t number(const char* key, std::uint32_t least, std::uint32_t most, std::uint32_t otherwise) {
        const auto at = from_.find(key);
        if (at == from_.end()) return otherwise;
        if (at->is_number_integer() && at->get<std::int64_t>() >= least && at->get<std::int64_t>() <= most)
            return at->get<std::uint32_t>();
        refuse(key, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
        return otherwise;
    }
    std::string text(const char* key, std::string otherwise) {
        const auto at = from_.find(key);
        if (at == from_.end()) return otherwise;
        if (at->is_string() && !at->get_ref<const std::string&>().empty()) return at->get<std::string>();
        refuse(key, "a text");
        return otherwise;
    }
    bool flag(const char* key) {
        const auto at = from_.find(key);
        if (at == from_.end()) return false;
        if (!at->is_boolean()) refuse(key, "true or false");
        return *at == true;
    }
    std::optional<geom::Rect> rect(const char* key) {
        const auto at = from_.find(key);
        if (at == from_.end()) return {};
        const auto fits = [](const json& n) {
            return n.is_number_integer() && n.get<std::int64_t>() >= 0 && n.get<std::int64_t>() <= kFarthest;
        };
        if (at->is_array() && at->size() == 4 && std::ranges::all_of(*at, fits)) {
            const geom::Rect rect{at->at(0), at->at(1), at->at(2), at->at(3)};
            if (!rect.empty()) return rect;
        }
        refuse(key, "[x, y, width, height] in pixels");
        return {};
    }

private:
    const json& from_;
    std::string error_;
};

Result<WatchRequest> one_request(const json& from) {
    if (!from.is_object()) return fail(": expected an object");
    Members members(from);
    WatchRequest out;
    out.tile = members.text("tile", "");
    out.wall = members.flag("wall");
    out.session = SessionId(members.number("session", 1, UINT32_MAX, 0));
    out.surface = SurfaceId(members.number("surface", 1, UINT32_MAX, 0));
    out.region = members.rect("region");
    out.output = members.flag("output");
    out.codec = members.text("codec", out.codec);
    out.width = members.number("width", 1, codec::kMaxExtent, 0);
    out.height = members.number("height", 1, codec::kMaxExtent, 0);
    out.fit = members.flag("fit");
    out.fps = members.number("fps", 1, WatchRequest::kMaxFps, out.fps);
    if (!members.error().empty()) return fail(members.error());
    if (!out.tile.empty() && out.wall) return fail(": expected a tile or the wall, not both");
    if (out.follows() && !out.session) return fail(": expected \"tile\": NAME, \"wall\": true or \"session\": NUMBER");
    if (out.output && out.tile.empty()) return fail(".output: expected a tile with it");
    if (out.surface && !out.session) return fail(".surface: expected a session with it");
    if (out.follows() && out.region) return fail(".region: goes with a tile or the wall; a window is shown as a whole");
    if (const auto known = codec::find_codec(out.codec); !known) return fail(".codec: " + known.error().message);
    return out;
}

}  // namespace

Result<std::vector<WatchRequest>> WatchRequest::parse(std::string_view message) {
    const auto parsed = parse_json(message, kRequestJson);
    const bool good = parsed && parsed->is_object() && parsed->contains("watch") && parsed->at("watch").is_array();
    if (!good) return fail("expected {\"watch\": [...]}");
    const json& watch = parsed->at("watch");
    if (watch.size() > kMost) return fail("watch: expected at most " + std::to_string(kMost) + " streams");
    std::vector<WatchRequest> out;
    for (const auto& item : watch) {
        auto request = one_request(item);
        if (!request) return fail("watch[" + std::to_string(out.size()) + "]" + request.error().message);
        out.push_back(std::move(*request));
    }
    return out;
}

}  // namespace wall::walld
