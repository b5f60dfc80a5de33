// SPDX-License-Identifier: MIT
#include "tools/request/request.h"

#include <fstream>

#include "common/json/parse_json.h"

namespace wall::request {
namespace {

constexpr std::chrono::seconds kConnectLimit{3};

tl::unexpected<Failure> no(const char* code, std::string message) {
    return tl::unexpected<Failure>({code, std::move(message)});
}

Outcome<proto::Envelope> request_of(const Walld& walld, const std::string& verb, const nlohmann::json& arguments) {
    const auto token = read_token(walld.token_file);
    if (!token) return tl::unexpected(token.error());
    proto::Envelope envelope;
    auto& request = *envelope.mutable_operator_request();
    request.set_request(1);
    request.set_verb(verb);
    request.set_json(arguments.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    request.set_token(*token);
    return envelope;
}

Outcome<proto::Envelope> answer_of(net::ControlClient& client, const Walld& walld, std::chrono::milliseconds limit) {
    auto answer = client.receive(limit);
    if (!answer) return no("unavailable", answer.error().message);
    if (answer->has_refused()) return no("forbidden", "walld refused: " + answer->refused().reason());
    if (!answer->has_operator_reply()) return no("failed", walld.address + " is no walld");
    return std::move(*answer);
}

}  // namespace

Outcome<std::string> read_token(const std::string& path) {
    if (path.empty()) return std::string();
    std::ifstream file(path);
    std::string token;
    if (std::getline(file, token) && !token.empty()) return token;
    return no("failed", path + ": expected a file with a token");
}

Outcome<net::ControlClient> subscribe(const Walld& walld, const std::string& verb, const nlohmann::json& arguments) {
    const auto request = request_of(walld, verb, arguments);
    if (!request) return tl::unexpected(request.error());
    const auto address = net::Address::parse(walld.address);
    if (!address) return no("invalid", address.error().message);
    auto client = net::ControlClient::connect(*address, kConnectLimit);
    if (!client)
        return no("unavailable", "walld cannot be reached at " + client.error().message +
                                     " (is it running? --walld or WALLGL_WALLD say where)");
    static_cast<void>(
        client->send(*request));  // who is refused is told so before, and receiving says what else went wrong
    return std::move(*client);
}

Outcome<Answer> ask(const Walld& walld, const std::string& verb, const nlohmann::json& arguments,
                    std::chrono::milliseconds limit) {
    auto client = subscribe(walld, verb, arguments);
    if (!client) return tl::unexpected(client.error());
    auto answer = answer_of(*client, walld, limit);
    if (!answer) return tl::unexpected(answer.error());
    auto& reply = *answer->mutable_operator_reply();
    if (!reply.ok()) return tl::unexpected<Failure>({reply.code(), reply.error()});
    auto json = parse_json(reply.json(), kAnswerJson);
    if (!json) return no("failed", "walld's answer: " + json.error().message);
    return Answer{std::move(*json), std::move(*reply.mutable_blob())};
}

}  // namespace wall::request
