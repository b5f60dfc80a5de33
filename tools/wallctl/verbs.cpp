// SPDX-License-Identifier: MIT
#include "tools/wallctl/verbs.h"

#include "common/net/control_client.h"

namespace wall::wallctl {
namespace {

constexpr std::chrono::seconds kConnectLimit{3};

}  // namespace

Result<Answer> ask(const std::string& walld, const std::string& verb, const nlohmann::json& arguments, std::chrono::milliseconds limit) {
    const auto address = net::Address::parse(walld);
    if (!address) return tl::unexpected(address.error());
    auto client = net::ControlClient::connect(*address, kConnectLimit);
    if (!client) return fail("walld cannot be reached at " + client.error().message + " (is it running? --walld or WALLGL_WALLD say where)");
    proto::Envelope envelope;
    auto& request = *envelope.mutable_operator_request();
    request.set_request(1);
    request.set_verb(verb);
    request.set_json(arguments.dump());
    if (auto sent = client->send(envelope); !sent) return tl::unexpected(sent.error());
    auto answer = client->receive(limit);
    if (!answer) return tl::unexpected(answer.error());
    if (answer->has_refused()) return fail("walld refused: " + answer->refused().reason());
    if (!answer->has_operator_reply()) return fail(address->text() + " is no walld");
    auto& reply = *answer->mutable_operator_reply();
    if (!reply.ok()) return fail(reply.error());
    return Answer{nlohmann::json::parse(reply.json(), nullptr, false), std::move(*reply.mutable_blob())};
}

}  // namespace wall::wallctl
