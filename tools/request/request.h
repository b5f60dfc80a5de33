// SPDX-License-Identifier: MIT
// One request to walld and its answer, or its answers. One thread.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "common/base/result.h"
#include "common/net/control_client.h"

namespace wall::request {

struct Answer {
    nlohmann::json json;
    std::string blob;
};

/// Why not: a code for programs (docs/http-api.md), a sentence for people.
struct Failure {
    std::string code, message;
};
template <class T>
using Outcome = Expected<T, Failure>;

/// What went wrong here, with the code for it.
inline tl::unexpected<Failure> failed(std::string message) {
    return tl::unexpected<Failure>({"failed", std::move(message)});
}

/// Where walld is, and as whom it is asked.
struct Walld {
    std::string address;
    std::string token_file;  ///< holds a token; empty: this Unix user asks
};

/// The token in a file; empty if `path` is.
Outcome<std::string> read_token(const std::string& path);

/// A connection on which walld answers the request with many replies.
Outcome<net::ControlClient> subscribe(const Walld& walld, const std::string& verb, const nlohmann::json& arguments);

Outcome<Answer> ask(const Walld& walld, const std::string& verb, const nlohmann::json& arguments,
                    std::chrono::milliseconds limit);

}  // namespace wall::request
