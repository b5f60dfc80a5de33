// SPDX-License-Identifier: MIT
// What an HTTP request asks for: the verb and its arguments (docs/http-api.md). Pure.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "walld/wall/refusal.h"

namespace wall::walld {

// What the server answers to a GET itself; all other paths are in rest.cpp.
inline constexpr std::string_view kSnapshotPath = "/api/v1/snapshot.png";
inline constexpr std::string_view kStreamPath = "/api/v1/stream";
inline constexpr std::string_view kMetricsPath = "/metrics";
inline constexpr std::string_view kHealthPath = "/healthz";
inline constexpr std::string_view kLogin = "/api/v1/login", kLogout = "/api/v1/logout";  ///< POST

struct RestRequest {
    std::string_view method, path, body;
    std::string_view content_type;
    std::string_view host, origin, fetch_site;  ///< headers of that name; Sec-Fetch-Site
    std::string_view scheme = "http";           ///< or "https"

    /// Browsers say where a request comes from; programs do not.
    bool same_site() const;
    /// The body says that it is JSON, which no form can send.
    bool is_json() const;
};

/// The HTTP side of a refusal. 404 for a path that is none, 405 for a method that it does not know.
struct HttpRefusal {
    int status;
    Refusal why;
};

struct RestCommand {
    std::string verb;
    nlohmann::json arguments;
};

/// A page of another site must not change the wall through a browser on this machine: what changes something is neither
/// sent from elsewhere nor a form.
Expected<RestCommand, HttpRefusal> rest_command(const RestRequest& request);

int http_status(RefusalKind kind);
/// {"error": {"code": ..., "message": ...}}
nlohmann::json error_json(const Refusal& refusal);

}  // namespace wall::walld
