// SPDX-License-Identifier: MIT
// A viewer's connection to walld (docs/streams.md): over the control connection, or a WebSocket. One thread.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "tools/request/request.h"

namespace wall::view {

using request::Failure;
using request::Outcome;
using request::Walld;

struct FeedMessage {
    bool binary = false;
    std::string data;  ///< JSON, or a frame
};

class Feed {
public:
    virtual ~Feed() = default;
    /// The next message, nothing if none comes within `limit`. After an error the feed is over.
    virtual Result<std::optional<FeedMessage>> next(std::chrono::milliseconds limit) = 0;
};

/// `watch`: the list in {"watch": [...]}. The control connection tells a wrong one with the first next().
Outcome<std::unique_ptr<Feed>> open_control_feed(const Walld& walld, const nlohmann::json& watch);
/// `url`: http://HOST[:PORT]; port 80 if not given.
Outcome<std::unique_ptr<Feed>> open_web_feed(const std::string& url, const std::string& token_file,
                                             const nlohmann::json& watch);

}  // namespace wall::view
