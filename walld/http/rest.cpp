// SPDX-License-Identifier: MIT
#include "walld/http/rest.h"

#include <optional>

#include "common/json/parse_json.h"

namespace wall::walld {
namespace {

using nlohmann::json;

struct Route {
    std::string_view method;
    std::string_view path;  ///< `*` is one part, the argument `key`
    const char* verb;
    const char* key;
};

constexpr Route kRoutes[] = {
    {"GET", "/api/v1/status", "status", nullptr},
    {"GET", "/api/v1/nodes", "nodes", nullptr},
    {"GET", "/api/v1/tiles", "tiles", nullptr},
    {"GET", "/api/v1/streams", "streams", nullptr},
    {"GET", "/api/v1/whoami", "whoami", nullptr},
    {"GET", "/api/v1/sessions", "sessions", nullptr},
    {"GET", "/api/v1/sessions/*", "session", "id"},
    {"DELETE", "/api/v1/sessions/*", "close", "id"},
    {"PUT", "/api/v1/sessions/*/placement", "place", "id"},
    {"POST", "/api/v1/sessions/*/raise", "raise", "id"},
    {"POST", "/api/v1/sessions/*/lower", "lower", "id"},
    {"POST", "/api/v1/sessions/*/hold", "hold", "id"},
    {"POST", "/api/v1/sessions/*/step", "step", "id"},
    {"POST", "/api/v1/sessions/*/weight", "weight", "id"},
    {"POST", "/api/v1/sessions/*/stereo", "stereo", "id"},
    {"POST", "/api/v1/sessions/*/move", "move", "id"},
    {"POST", "/api/v1/reload", "reload", nullptr},
    {"POST", "/api/v1/pattern", "pattern", nullptr},
    {"POST", "/api/v1/nodes", "add_node", nullptr},
    {"DELETE", "/api/v1/nodes/*", "remove_node", "name"},
    {"POST", "/api/v1/nodes/*/drain", "drain_node", "name"},
    {"POST", "/api/v1/nodes/*/undrain", "undrain_node", "name"},
    {"GET", "/api/v1/layouts", "layouts", nullptr},
    {"GET", "/api/v1/layouts/*", "layout", "name"},
    {"PUT", "/api/v1/layouts/*", "save_layout", "name"},
    {"DELETE", "/api/v1/layouts/*", "delete_layout", "name"},
    {"POST", "/api/v1/layouts/*/load", "load_layout", "name"},
};

/// The part of `path` where the pattern has its `*` (empty without one); nothing if the path is another one.
std::optional<std::string_view> match(std::string_view pattern, std::string_view path) {
    const auto star = pattern.find('*');
    if (star == std::string_view::npos) return pattern == path ? std::optional(std::string_view()) : std::nullopt;
    const auto before = pattern.substr(0, star), after = pattern.substr(star + 1);
    if (path.size() <= before.size() + after.size() || !path.starts_with(before) || !path.ends_with(after))
        return std::nullopt;
    const auto part = path.substr(before.size(), path.size() - before.size() - after.size());
    return part.find('/') == std::string_view::npos ? std::optional(part) : std::nullopt;
}

tl::unexpected<HttpRefusal> no(int status, RefusalKind kind, std::string message) {
    return tl::unexpected<HttpRefusal>({status, {kind, std::move(message)}});
}

Expected<RestCommand, HttpRefusal> command(const Route& route, std::string_view part, const RestRequest& request) {
    RestCommand out{route.verb, json::object()};
    if (route.method != "GET") {
        if (!request.same_site())
            return no(403, RefusalKind::forbidden, "a page of another site may not change this wall");
        const bool needs_type = route.method != "DELETE" || !request.body.empty();  // no form can send a DELETE
        if (needs_type && !request.is_json())
            return no(415, RefusalKind::invalid, "expected 'Content-Type: application/json'");
        if (!request.body.empty()) {
            auto arguments = parse_json(request.body, kRequestJson);
            if (!arguments) return no(400, RefusalKind::invalid, arguments.error().message);
            out.arguments = std::move(*arguments);
        }
        if (!out.arguments.is_object()) return no(400, RefusalKind::invalid, "expected a JSON object");
    }
    if (route.key) out.arguments[route.key] = part;
    return out;
}

}  // namespace

bool RestRequest::same_site() const {
    const bool fetched_here = fetch_site.empty() || fetch_site == "same-origin" || fetch_site == "none";
    return fetched_here && (origin.empty() || origin == std::string(scheme) + "://" + std::string(host));
}

/// `application/json`, with or without parameters.
bool RestRequest::is_json() const { return content_type.substr(0, content_type.find(';')) == "application/json"; }

Expected<RestCommand, HttpRefusal> rest_command(const RestRequest& request) {
    std::string allowed;
    for (const auto& route : kRoutes) {
        const auto part = match(route.path, request.path);
        if (!part) continue;
        if (route.method == request.method || (route.method == "GET" && request.method == "HEAD"))
            return command(route, *part, request);
        allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
    }
    if (allowed.empty()) return no(404, RefusalKind::not_found, "not found");
    return no(405, RefusalKind::invalid, "expected " + allowed);
}

int http_status(RefusalKind kind) {
    switch (kind) {
        case RefusalKind::invalid: return 400;
        case RefusalKind::forbidden: return 403;
        case RefusalKind::not_found: return 404;
        case RefusalKind::conflict: return 409;
        case RefusalKind::busy: return 429;
        case RefusalKind::unavailable: return 503;
        case RefusalKind::failed: return 500;
    }
    return 500;
}

json error_json(const Refusal& refusal) {
    return {{"error", {{"code", name_of(refusal.kind)}, {"message", refusal.message}}}};
}

}  // namespace wall::walld
