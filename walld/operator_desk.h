// SPDX-License-Identifier: MIT
// Carries out what operators ask for (wallctl): verbs with JSON arguments. One thread.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "walld/changed.h"
#include "walld/snapshot_desk.h"
#include "walld/wall.h"

namespace wall::walld {

class OperatorDesk {
public:
    /// `end_session` cuts a client off. `changed` is notified after every event of the wall.
    OperatorDesk(Wall& wall, SnapshotDesk& snapshots, Changed& changed, std::function<void(SessionId)> end_session)
        : wall_(wall), snapshots_(snapshots), changed_(changed), end_session_(std::move(end_session)) {}

    asio::awaitable<proto::OperatorReply> answer(proto::OperatorRequest request);

private:
    struct Answer {
        nlohmann::json json = nlohmann::json::object();
        std::string blob;
    };
    using Arguments = const nlohmann::json&;
    using Verb = asio::awaitable<Result<Answer>> (OperatorDesk::*)(Arguments);
    struct Row {
        const char* name;
        Verb run;
    };
    static const Row kVerbs[];

    asio::awaitable<Result<Answer>> run(const std::string& verb, Arguments arguments);
    asio::awaitable<Result<Answer>> status(Arguments);
    asio::awaitable<Result<Answer>> nodes(Arguments);
    asio::awaitable<Result<Answer>> tiles(Arguments);
    asio::awaitable<Result<Answer>> sessions(Arguments);
    asio::awaitable<Result<Answer>> place(Arguments);
    asio::awaitable<Result<Answer>> raise(Arguments);
    asio::awaitable<Result<Answer>> lower(Arguments);
    asio::awaitable<Result<Answer>> close(Arguments);
    asio::awaitable<Result<Answer>> screenshot(Arguments);
    asio::awaitable<Result<Answer>> hold(Arguments);
    asio::awaitable<Result<Answer>> step(Arguments);
    asio::awaitable<Result<Answer>> wait(Arguments);

    Wall& wall_;
    SnapshotDesk& snapshots_;
    Changed& changed_;
    std::function<void(SessionId)> end_session_;
};

}  // namespace wall::walld
