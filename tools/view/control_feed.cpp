// SPDX-License-Identifier: MIT
#include "tools/view/feed.h"

namespace wall::view {
namespace {

class ControlFeed : public Feed {
public:
    explicit ControlFeed(net::ControlClient client) : client_(std::move(client)) {}

    Result<std::optional<FeedMessage>> next(std::chrono::milliseconds limit) override {
        auto message = client_.poll(limit);
        if (!message) return tl::unexpected(message.error());
        if (!*message) return std::nullopt;
        if ((*message)->has_refused()) return fail("walld refused: " + (*message)->refused().reason());
        if (!(*message)->has_operator_reply()) return fail("this is no walld");
        auto& reply = *(*message)->mutable_operator_reply();
        if (!reply.ok()) return fail(reply.error());
        const bool binary = !reply.blob().empty();
        return FeedMessage{binary, std::move(binary ? *reply.mutable_blob() : *reply.mutable_json())};
    }

private:
    net::ControlClient client_;
};

}  // namespace

Outcome<std::unique_ptr<Feed>> open_control_feed(const Walld& walld, const nlohmann::json& watch) {
    auto client = request::subscribe(walld, "watch", {{"watch", watch}});
    if (!client) return tl::unexpected(client.error());
    return std::make_unique<ControlFeed>(std::move(*client));
}

}  // namespace wall::view
