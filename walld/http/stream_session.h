// SPDX-License-Identifier: MIT
// One viewer's WebSocket (RFC 6455, docs/streams.md): what it says goes to the hub, what waits for it there goes out.
#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>

#include "walld/http/web_stream.h"
#include "walld/streams/still_may.h"
#include "walld/streams/stream_hub.h"

namespace wall::walld {

namespace asio = boost::asio;

/// Serves the viewer until either side closes, or they may watch no more. `request` is an upgrade that was checked;
/// `viewer` is removed from the hub in the end. Gives why they may not.
asio::awaitable<Outcome<void>> serve_viewer(std::shared_ptr<WebStream> socket,
                                            boost::beast::http::request<boost::beast::http::string_body> request,
                                            StreamHub& hub, std::shared_ptr<StreamHub::Viewer> viewer, StillMay still);

}  // namespace wall::walld
