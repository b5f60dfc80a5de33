// SPDX-License-Identifier: MIT
// Programs that are recorded as commands (docs/recordings.md). Whoever records is one more node of that one session,
// for its program alone: it has no tile, is in no swap group, and nobody else hears of it.
#include "common/base/address.h"
#include "common/tls/secret.h"
#include "walld/wall/wall.h"

namespace wall::walld {
namespace {

proto::Envelope recorder_up(const Recorder& recorder) {
    proto::Envelope out;
    auto& up = *out.mutable_node_up();
    up.set_node(recorder.node.value);
    up.set_address(recorder.address);
    up.set_ticket(recorder.ticket);
    up.set_incarnation(recorder.incarnation);
    up.set_records(true);
    return out;
}

}  // namespace

/// Its number is the one behind those of the nodes, so that programs need no other way to name it.
Outcome<std::string> Wall::begin_recording(SessionId id, const std::string& address) {
    auto* session = find(id);
    const auto name = "session " + std::to_string(id.value);
    if (!session) return refuse(RefusalKind::not_found, "there is no " + name);
    if (const auto parsed = Address::parse(address); !parsed)
        return refuse(RefusalKind::invalid, "'address': " + parsed.error().message);
    if (session->group)
        return refuse(RefusalKind::conflict,
                      name +
                          " is a parallel program: its processes draw in streams of their own, and a recording has "
                          "one");
    if (!session->owner.machine.empty())
        return refuse(RefusalKind::conflict, name + " runs on another machine, " + session->owner.text() +
                                                 "; only programs of walld's machine can be recorded as commands");
    if (session->recorder) return refuse(RefusalKind::conflict, name + " is being recorded already");
    session->recorder = {.node = NodeIndex(static_cast<std::uint32_t>(nodes_.size())),
                         .incarnation = ++session->recordings,
                         .address = address,
                         .ticket = random_(kTicketBytes)};
    out_.to_client(id, recorder_up(*session->recorder));
    return session->recorder->ticket;
}

bool Wall::is_recorded(SessionId id, const std::string& ticket) const {
    const auto found = sessions_.find(id);
    return found != sessions_.end() && found->second.recorder &&
           tls::same_secret(found->second.recorder->ticket, ticket);
}

void Wall::end_recording(SessionId id, const std::string& ticket) {
    if (!is_recorded(id, ticket)) return;
    auto& recorder = sessions_.at(id).recorder;
    proto::Envelope down;
    down.mutable_node_down()->set_node(recorder->node.value);
    recorder.reset();
    out_.to_client(id, down);
}

/// Their numbers are those of nodes now.
void Wall::end_crossed_recordings() {
    for (auto& [id, session] : sessions_)
        if (session.recorder && nodes_.contains(session.recorder->node))
            end_recording(id, std::string(session.recorder->ticket));
}

}  // namespace wall::walld
