// SPDX-License-Identifier: MIT
#include "walld/control/control_server.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>

#include "common/daemon/keep_running.h"
#include "common/json/parse_json.h"
#include "common/log/log.h"
#include "common/log/refusals.h"
#include "common/net/as_tuple.h"
#include "common/net/base64.h"
#include "walld/control/arguments.h"
#include "walld/control/random_bytes.h"
#include "walld/streams/still_may.h"
#include "walld/wall/messages.h"
#include "walld/wall/status.h"

namespace wall::walld {
namespace {

constexpr const char* kWatchVerb = "watch";    // the one verb with many answers
constexpr const char* kRecordVerb = "record";  // what it began lasts as long as the connection
constexpr std::chrono::seconds kLookAtConnection{1};
constexpr std::chrono::seconds kLastWords{1};  // for a machine that was revoked to read why
constexpr const char* kNotKnownYet = "somebody whose name is being looked up";
constexpr const char* kHere = "control";  // where it was, of what is refused

bool answer_ping(net::ControlConnection& connection, const proto::Envelope& message) {
    if (!message.has_ping()) return false;
    proto::Envelope pong;
    pong.mutable_pong();
    connection.send(pong);
    return true;
}

/// For the log: who it is, or of a machine where it is and its key.
std::string peer_name(const net::ControlConnection& connection, const Person& who) {
    if (who.kind != Person::Kind::unknown) return who.text();
    const auto& key = connection.peer_key();
    return connection.address() + (key ? " with the key " + key->text() : "");
}

}  // namespace

ControlServer::ControlServer(asio::any_io_executor executor, Description description, WallFile file,
                             Identities identities, WalldKeys keys, const std::string& state)
    : executor_(executor),
      changed_(executor),
      identities_(std::move(identities)),
      who_(executor, [this](std::uint32_t user) { return identities_.of(user); }),
      wall_(std::move(description.config), *this, random_bytes),
      machines_(std::move(keys), wall_.config(), *this, random_bytes),
      snapshots_(executor, wall_, *this),
      streams_(executor, wall_, *this),
      description_(std::move(file), std::move(description.toml), state,
                   {wall_, identities_, who_, machines_, streams_, *this, *this}),
      operators_(wall_, snapshots_, streams_, LayoutStore(state), machines_, identities_.tokens(), description_,
                 changed_,
                 [this](SessionId id, const std::string& reason) {
                     end_session(id, reason);
                     wall_.close_session(id);
                 }),
      deadline_timer_(executor),
      process_timer_(executor) {}

Result<void> ControlServer::listen() {
    listeners_.clear();  // of an attempt before, which one of the addresses has ended
    for (const auto& address : wall_.config().control_listen) {
        auto listener = net::Listener::open(executor_, address,
                                            machines_.tls() ? net::Peers::with_keys : net::Peers::of_this_machine);
        if (!listener) return tl::unexpected(listener.error());
        listeners_.push_back(std::make_unique<net::Listener>(std::move(*listener)));
        log::info("control_listening address={} tls={}", log::quoted(listeners_.back()->address().text()),
                  listeners_.back()->wants_keys());
    }
    for (auto& listener : listeners_) {
        const bool wants_keys = listener->wants_keys();
        net::keep_accepting(
            executor_, *listener,
            [this, wants_keys](net::StreamSocket socket) {
                if (wants_keys) net::spawn(executor_, "handshake", take_over_tls(std::move(socket)));
                else take(net::Stream(std::move(socket)));
            },
            [this] { return stopping_; });
    }
    keep("deadlines", &ControlServer::run_deadlines);
    keep("peers", &ControlServer::watch_peers);
    return {};
}

void ControlServer::keep(const char* name, asio::awaitable<void> (ControlServer::*work)()) {
    net::keep_running(executor_, {name, [this, work] { return (this->*work)(); }, [this] { return stopping_; }});
}

void ControlServer::stop() {
    stopping_ = true;
    for (auto& listener : listeners_) listener->close();
    for (auto& [at, connection] : std::exchange(all_, {})) {
        if (const auto open = connection.lock()) open->close();
    }
    deadline_timer_.cancel();
    process_timer_.cancel();
    changed_.notify();
}

std::vector<net::Address> ControlServer::addresses() const {
    std::vector<net::Address> out;
    for (const auto& listener : listeners_) out.push_back(listener->address());
    return out;
}

void ControlServer::to_node(NodeIndex node, const proto::Envelope& message) {
    if (const auto found = nodes_.find(node); found != nodes_.end()) found->second.connection->send(message);
}

void ControlServer::to_client(SessionId session, const proto::Envelope& message) {
    for (const auto& [client, link] : clients_)
        if (client.first == session) link.connection->send(message);
}

void ControlServer::to_member(SessionId session, Rank rank, const proto::Envelope& message) {
    if (const auto found = clients_.find({session, rank}); found != clients_.end())
        found->second.connection->send(message);
}

void ControlServer::end_session(SessionId session, const std::string& reason) {
    log::warn("session_cut session={} reason={}", session.value, log::quoted(reason));
    for (const auto& [client, link] : clients_)
        if (client.first == session) refuse(link.connection, reason);
}

// ---- connections ----

/// Somebody from anywhere: until a key is proven it takes a place among those that may try at the same time.
asio::awaitable<void> ControlServer::take_over_tls(net::StreamSocket socket) {
    const auto from = net::peer_text(socket.native_handle());
    const auto place = handshakes_.take(from);
    if (!place) {
        log::refused(kHere, from, place.error().message);
        co_return;
    }
    auto stream = co_await net::Stream::accept_tls(std::move(socket), *machines_.tls());
    if (stream) co_return take(std::move(*stream));
    log::refused(kHere, from, stream.error().message);
}

void ControlServer::take(net::Stream stream) {
    auto connection = std::make_shared<net::ControlConnection>(std::move(stream));
    all_[connection.get()] = connection;
    net::spawn(executor_, "connection", serve(std::move(connection)));
}

void ControlServer::refuse(const Connection& connection, const std::string& reason, bool over) {
    auto message = refused(reason);
    if (over) message.mutable_refused()->set_over(true);
    connection->send(message);
    connection->close_after_sending();
}

/// Who is told that they may not, and the log with them. Of a peer on another machine the address is said.
void ControlServer::turn_away(const Connection& connection, const Person& who, const std::string& reason) {
    log::refused(kHere, peer_name(*connection, who), reason);
    refuse(connection, reason);
}

asio::awaitable<void> ControlServer::serve(Connection connection) {
    const auto& key = connection->peer_key();
    auto place = peers_.take(key ? "key " + key->text() : kNotKnownYet);
    Person who;
    if (place && !key) {
        who = co_await who_.at(connection->ends());
        place->leave();
        place = peers_.take(who.text());
    }
    if (!place) {
        turn_away(connection, who, place.error().message);
    } else if (key) {
        co_await serve_machine(connection, std::move(*place));
    } else if (who.role == Role::none) {
        turn_away(connection, who, who.text() + " may not use this wall: add them to [people] in wall.toml");
    } else {
        const auto from = peer_name(*connection, who);
        if (auto first = co_await first_message(connection, from))
            co_await serve_first(connection, std::move(*first), std::move(who), std::move(*place));
    }
    all_.erase(connection.get());
    connection->close_after_sending();
}

/// Somebody who may use the wall, and what they have begun with.
asio::awaitable<void> ControlServer::serve_first(Connection connection, proto::Envelope first, Person who,
                                                 Quota::Place place) {
    if (first.has_node_hello()) co_await serve_node(connection, first.node_hello(), who, std::move(place));
    else if (first.has_client_hello())
        co_await serve_client(connection, first.client_hello(), std::move(who), std::move(place));
    else if (first.has_operator_request()) co_await serve_operator(connection, std::move(first), std::move(who));
    else turn_away(connection, who, "expected a hello of a node or a client, or an operator's request");
}

/// Over TLS comes a machine that joins, a node, or a client host for one of its people.
asio::awaitable<void> ControlServer::serve_machine(Connection connection, Quota::Place place) {
    const tls::Fingerprint key = *connection->peer_key();
    const auto from = peer_name(*connection, {});
    auto first = co_await first_message(connection, from);
    if (!first) co_return;
    const auto no = [&](const Refusal& why) { turn_away(connection, {}, why.message); };
    if (first->has_join_request()) {
        const auto answer = machines_.join(first->join_request(), key, Clock::now());
        if (!answer) co_return no(answer.error());
        log::info("machine_joined kind={} name={} key={}",
                  log::quoted(first->join_request().node() ? "node" : "client"), log::quoted(answer->name()),
                  log::quoted(key.text()));
        connection->send(make(&proto::Envelope::mutable_join_answer, *answer));
    } else if (first->has_node_hello()) {
        const auto who = machines_.node(first->node_hello(), key);
        if (!who) co_return no(who.error());
        co_await serve_node(connection, first->node_hello(), *who, std::move(place));
    } else if (first->has_host_hello()) {
        auto who = machines_.user(first->host_hello(), key);
        if (!who) co_return no(who.error());
        place.leave();
        auto own = peers_.take(who->text());
        if (!own) co_return no(own.error());
        const auto user = who->text();
        auto message = co_await first_message(connection, user);
        if (message && message->has_node_hello()) co_return no({RefusalKind::forbidden, "a client host runs no nodes"});
        if (message) co_await serve_first(connection, std::move(*message), std::move(*who), std::move(*own));
    } else {
        no({RefusalKind::invalid, "expected a machine that joins, a node or a client host"});
    }
}

std::set<tls::Fingerprint> ControlServer::connected() const {
    std::set<tls::Fingerprint> out;
    for (const auto& [key, connection] : all_)
        if (const auto open = connection.lock(); open && open->is_open() && open->peer_key())
            out.insert(*open->peer_key());
    return out;
}

/// They are told why; one that does not read that is closed all the same.
void ControlServer::cut(const tls::Fingerprint& key, const std::string& reason) {
    for (const auto& [at, connection] : std::map(all_)) {
        const auto open = connection.lock();
        if (!open || open->peer_key() != key) continue;
        refuse(open, reason);
        const auto limit = std::make_shared<asio::steady_timer>(executor_, kLastWords);
        limit->async_wait([open, limit](const boost::system::error_code&) { open->close(); });
    }
}

asio::awaitable<Result<proto::Envelope>> ControlServer::first_message(Connection connection, std::string from) {
    auto limit = std::make_shared<asio::steady_timer>(executor_, kHelloLimit);
    const auto silent = std::make_shared<bool>(false);
    limit->async_wait([connection, limit, silent](const boost::system::error_code& error) {
        if (error) return;
        *silent = true;
        connection->close();
    });
    auto message = co_await connection->receive();
    limit->cancel();
    if (*silent) log::refused(kHere, from, "no first message came");
    else if (!message && message.error().message != "closed") log::refused(kHere, from, message.error().message);
    co_return message;
}

// ---- nodes ----

/// There are as many nodes as wall.toml describes, so `place` is given back when this is one.
asio::awaitable<void> ControlServer::serve_node(Connection connection, proto::NodeHello hello, const Person& who,
                                                Quota::Place place) {
    hello.set_address(net::reachable_at(hello.address(), connection->ends()));
    // Nodes get every session's tickets and pixels.
    if (const auto permitted = may(who, Need::operate, "run a node", nullptr); !permitted) {
        co_return turn_away(connection, who, permitted.error().message);
    }
    const auto joined = admit_node(connection, hello, who);
    if (!joined) co_return turn_away(connection, who, joined.error().message);
    place.leave();
    log::info("node_up node={} incarnation={} address={} backend={} renderer={}", log::quoted(hello.name()),
              wall_.nodes()[*joined].incarnation, log::quoted(hello.address()), log::quoted(hello.backend()),
              log::quoted(hello.caps().renderer()));
    description_.tell(*joined);
    streams_.node_joined(*joined);
    something_changed();
    for (;;) {
        auto message = co_await connection->receive();
        if (!serves(*joined, connection)) co_return;  // another process is the node now, or it was silent for too long
        if (message) nodes_[*joined].silent_checks = 0;
        if (message && answer_ping(*connection, *message)) continue;
        const auto result = message ? node_says(*joined, *message) : Result<void>(tl::unexpected(message.error()));
        if (!result) co_return drop_node(*joined, result.error().message, connection->lost() && connection->peer_key());
        something_changed();
    }
}

/// A process that was started later takes the place of one whose link may be dead, but for one of another user.
Result<NodeIndex> ControlServer::admit_node(const Connection& connection, const proto::NodeHello& hello,
                                            const Person& who) {
    const auto index = wall_.check_node(hello);
    if (!index) return index;
    if (const auto before = nodes_.find(*index); before != nodes_.end()) {
        if (!before->second.who.same_as(who))
            return fail("node '" + hello.name() + "' is already here, as a process of " + before->second.who.text());
        refuse(before->second.connection, "process " + std::to_string(hello.pid()) + " is this node now");
        drop_node(*index, "process " + std::to_string(hello.pid()) + " has come in its place", true);
    }
    nodes_[*index] = {connection, who};  // before it joins, because joining sends
    return wall_.node_joins(hello, Clock::now());
}

bool ControlServer::serves(NodeIndex node, const Connection& connection) const {
    const auto found = nodes_.find(node);
    return found != nodes_.end() && found->second.connection == connection;
}

void ControlServer::let_go(NodeIndex node, const std::string& reason) {
    if (nodes_.contains(node)) drop_node(node, reason);
}

void ControlServer::drop_node(NodeIndex node, const std::string& reason, bool link_lost) {
    nodes_.extract(node).mapped().connection->close_after_sending();
    wall_.node_leaves(node, Clock::now(), link_lost);
    snapshots_.node_left(node);
    streams_.node_left(node);
    log::info("node_down node={} reason={}", log::quoted(wall_.nodes()[node].config->name), log::quoted(reason));
    something_changed();
}

Result<void> ControlServer::node_says(NodeIndex node, proto::Envelope& message) {
    if (message.has_rendered()) {
        wall_.node_rendered(node, message.rendered(), Clock::now());
    } else if (message.has_snapshot()) {
        snapshots_.arrived(node, *message.mutable_snapshot());
    } else if (message.has_stream_frame()) {
        streams_.arrived(node, *message.mutable_stream_frame());
    } else if (message.has_node_stats()) {
        wall_.node_reports(node, message.node_stats(), std::chrono::system_clock::now(), Clock::now());
    } else if (message.has_tiles_taken()) {
        wall_.node_took_tiles(node, message.tiles_taken().tiles_version());
    } else if (message.has_session_fault()) {
        wall_.node_faults(node, message.session_fault());
        log::warn("session_fault session={} node={} reason={}", message.session_fault().session(),
                  log::quoted(wall_.nodes()[node].config->name), log::quoted(message.session_fault().reason()));
    } else {
        return fail("a node may not send that message");
    }
    return {};
}

// ---- clients ----

/// While the wall starts, until all nodes are there; later until one is.
asio::awaitable<void> ControlServer::wait_for_nodes() {
    const auto until = Clock::now() + kNodeLimit;
    const auto ready = [&] {
        const auto there = [](const Node& node) { return node.up || node.duty != Duty::serves; };
        const bool all = std::ranges::all_of(wall_.nodes(), there);
        return all || (wall_.any_node_up() && Clock::now() > started_ + kNodeLimit);
    };
    while (!ready() && Clock::now() < until && !stopping_) co_await changed_.wait(until);
}

/// Whose program it is, and whether it may come now.
Outcome<void> ControlServer::welcome(const proto::ClientHello& hello, Person& who) const {
    auto owner = identities_.with_token(who, hello.token());
    if (!owner) return tl::unexpected(owner.error());
    who = std::move(*owner);
    if (who.role < Role::user)
        return walld::refuse(RefusalKind::forbidden,
                             who.text() +
                                 " may not put programs on this wall: that needs the role user, and theirs is " +
                                 config::name_of(who.role));
    if (auto good = wall_.check(hello); !good) return good;
    if (auto good = wall_.check_quota(hello, who); !good) return good;
    return wall_.check_member(hello, who);
}

/// Programs on the wall have a limit of their own (max_sessions), so `place` is given back when this is one.
asio::awaitable<void> ControlServer::serve_client(Connection connection, proto::ClientHello hello, Person who,
                                                  Quota::Place place) {
    if (hello.has_resume()) give_way(hello.resume(), hello.group().rank());
    if (const auto good = welcome(hello, who); !good) co_return turn_away(connection, who, good.error().message);
    co_await wait_for_nodes();
    if (!wall_.any_node_up())
        co_return refuse(connection, "no node of the wall is up: is a tileserver running? (wallctl nodes)");
    for (const auto& still : {wall_.check(hello), wall_.check_quota(hello, who), wall_.check_member(hello, who)})
        if (!still) co_return turn_away(connection, who, still.error().message);
    if (const auto comeback = wall_.comeback(hello, Clock::now()); comeback != Wall::Comeback::may_come)
        co_return refuse(connection, "the wall does not know parallel program '" + hello.group().name() + "' any more",
                         comeback == Wall::Comeback::over);
    const Rank rank = hello.group().rank();
    const auto id = wall_.open_session(hello, who, Clock::now(), [&](SessionId session) {
        clients_[{session, rank}] = {connection};
    });
    place.leave();
    log::info("session_open session={} owner={} pid={} program={} name={} group={} rank={}", id.value,
              log::quoted(who.text()), hello.pid(), log::quoted(hello.program()), log::quoted(hello.name()),
              log::quoted(hello.group().name()), rank);
    something_changed();
    std::string reason;
    bool moved = false;
    while (reason.empty()) {
        auto message = co_await connection->receive();
        if (!serves({id, rank}, connection)) co_return;  // the program has come on another one
        if (message) clients_[{id, rank}].silent_checks = 0;
        if (message && answer_ping(*connection, *message)) continue;
        if (message && message->has_program_ended() && !who.machine.empty()) {
            reason = "closed";
            break;
        }
        if (message && message->has_move_answer() && message->move_answer().refused().empty()) {
            wall_.move_answered(id, message->move_answer());
            reason = "it has moved to another wall";
            moved = true;
            break;
        }
        const auto result = message ? client_says({id, rank}, *message) : Result<void>(tl::unexpected(message.error()));
        if (!result) reason = result.error().message;
        if (message && !result) refuse(connection, reason);
        something_changed();
    }
    const bool may_come = !moved && connection->lost() && !who.machine.empty();
    clients_.erase({id, rank});
    if (may_come) {
        wall_.await_again(id, rank, Clock::now());
        log::warn("session_lost session={} rank={} reason={}", id.value, rank, log::quoted(reason));
    } else {
        const auto became = wall_.member_gone(id, rank);
        log::info("session_end session={} rank={} reason={} became={}", id.value, rank, log::quoted(reason),
                  log::quoted(became));
    }
    something_changed();
}

bool ControlServer::serves(const ClientId& client, const Connection& connection) const {
    const auto found = clients_.find(client);
    return found != clients_.end() && found->second.connection == connection;
}

/// A program that comes again while the link on which it was is not known to be dead yet.
void ControlServer::give_way(const proto::Resume& resume, Rank rank) {
    const SessionId id(resume.session());
    const auto before = clients_.find({id, rank});
    if (before == clients_.end() || !wall_.is_program_of(id, resume)) return;
    log::warn("session_lost session={} rank={} reason={}", id.value, rank, log::quoted("it has come again"));
    before->second.connection->close();
    clients_.erase(before);
    wall_.await_again(id, rank, Clock::now());
}

Result<void> ControlServer::client_says(const ClientId& client, const proto::Envelope& message) {
    const auto& [session, rank] = client;
    if (message.has_surface_open()) return wall_.open_surface(session, message.surface_open(), Clock::now(), rank);
    if (message.has_surface_resize()) wall_.resize_surface(session, message.surface_resize(), rank);
    else if (message.has_surface_adopted()) wall_.adopt_placement(session, message.surface_adopted(), Clock::now());
    else if (message.has_client_stats()) wall_.client_reports(session, rank, message.client_stats(), Clock::now());
    else if (message.has_close_refused()) wall_.cannot_close(session, SurfaceId(message.close_refused().surface()));
    else if (message.has_move_answer()) wall_.move_answered(session, message.move_answer());
    else if (message.has_surface_close())
        wall_.close_surface(session, SurfaceId(message.surface_close().surface()), rank);
    else if (message.has_placement_noted()) wall_.placement_noted(session, rank, message.placement_noted());
    else if (message.has_member_leaves()) wall_.member_leaves(session, rank);
    else return fail("a client may not send that message");
    return {};
}

// ---- operators ----

asio::awaitable<void> ControlServer::serve_operator(Connection connection, proto::Envelope first, Person who) {
    Result<proto::Envelope> message(std::move(first));
    while (message && message->has_operator_request()) {
        auto& request = *message->mutable_operator_request();
        if (auto place = requests_.take(who.text()); place) {
            net::spawn(executor_, "operator", answer_operator(connection, std::move(request), who, std::move(*place)));
        } else {
            Outcome<Answer> no = tl::unexpected(place.error());
            co_await send_answer(connection, request.request(), std::move(no));
        }
        message = co_await connection->receive();
    }
}

/// In parts, each when the one before is gone: an answer may be as large as a picture of the wall.
asio::awaitable<void> ControlServer::send_answer(Connection connection, std::uint32_t number, Outcome<Answer> answer) {
    proto::OperatorReply reply;
    reply.set_request(number);
    reply.set_ok(answer.has_value());
    if (!answer) {
        reply.set_error(answer.error().message);
        reply.set_code(name_of(answer.error().kind));
    }
    const auto json = answer ? dump(answer->json) : std::string();
    const auto blob = answer ? answer->blob : nullptr;
    const std::string_view bytes = blob ? std::string_view(*blob) : std::string_view();
    net::ReplyParts parts(std::move(reply), json, bytes, {});
    co_await send_parts(connection, std::move(parts));
}

asio::awaitable<void> ControlServer::send_parts(Connection connection, net::ReplyParts parts) {
    for (auto part = parts.next(); part && connection->is_open(); part = parts.next()) {
        const bool last = !part->more();
        connection->send(make(&proto::Envelope::mutable_operator_reply, *part));
        if (!last) co_await connection->drained();
    }
}

asio::awaitable<void> ControlServer::answer_operator(Connection connection, proto::OperatorRequest request, Person who,
                                                     Quota::Place place) {
    auto person = identities_.with_token(who, request.token());
    Outcome<Answer> answer;
    if (!person) {
        log::refused(kHere, peer_name(*connection, who), person.error().message);
        answer = tl::unexpected(person.error());
    } else if (request.verb() == kWatchVerb) {
        place.leave();  // what is watched has limits of its own
        const auto permitted = may_watch(who, request.token());
        if (permitted) co_return co_await serve_watch(connection, std::move(request), std::move(who));
        log::refused(kHere, person->text(), permitted.error().message);
        answer = tl::unexpected(permitted.error());
    } else {
        Result<nlohmann::json> arguments = nlohmann::json::object();
        if (!request.json().empty()) arguments = parse_json(request.json(), kRequestJson);
        if (arguments) {
            Asked asked{request.verb(), std::move(*arguments), std::move(*person), "control"};
            answer = co_await operators_.carry_out(asked);
            if (answer && asked.verb == kRecordVerb) {
                place.leave();  // a session has one recording
                co_return co_await serve_recording(connection, std::move(request), std::move(asked), *answer);
            }
        } else {
            answer = walld::refuse(RefusalKind::invalid, "arguments: " + arguments.error().message);
        }
    }
    co_await send_answer(connection, request.request(), std::move(answer));
    something_changed();
}

/// The recording that has begun, until the connection or the recording ends, or they may not any more.
asio::awaitable<void> ControlServer::serve_recording(Connection connection, proto::OperatorRequest request, Asked asked,
                                                     Answer begun) {
    const auto secret = net::from_base64(begun.json.at("ticket").get<std::string>());
    const std::string ticket(reinterpret_cast<const char*>(secret.data()), secret.size());
    const SessionId session = text_of(asked.arguments, "id").and_then(&Target::parse).value().session;
    const Person who = asked.who;
    StillMay still([&] {
        auto person = identities_.with_token(who, request.token());
        if (!person) return Outcome<void>(tl::unexpected(person.error()));
        asked.who = std::move(*person);
        return operators_.permits(asked);
    });
    log::info("recording_begins session={} who={}", session.value, log::quoted(who.text()));
    co_await send_answer(connection, request.request(), Outcome<Answer>(std::move(begun)));
    something_changed();
    while (connection->is_open() && !stopping_ && wall_.is_recorded(session, ticket) && still.at(Clock::now()))
        co_await changed_.wait(std::min(still.next(), Clock::now() + kLookAtConnection));
    const bool recorded = wall_.is_recorded(session, ticket);
    wall_.end_recording(session, ticket);
    log::info("recording_ends session={}", session.value);
    Outcome<Answer> why =
        walld::refuse(RefusalKind::unavailable,
                      wall_.sessions().contains(session) ? "the wall has other nodes now" : "the program has ended");
    if (recorded && !still.last()) why = tl::unexpected(still.last().error());
    if (connection->is_open()) co_await send_answer(connection, request.request(), std::move(why));
    something_changed();
}

/// As whom somebody watches.
Outcome<Person> ControlServer::may_watch(const Person& who, const std::string& token) const {
    auto person = identities_.with_token(who, token);
    if (!person) return person;
    if (const auto permitted = may(*person, Need::look, "watch the wall", nullptr); !permitted)
        return tl::unexpected(permitted.error());
    return person;
}

/// Replies for as long as the connection lasts and they may watch: what a WebSocket viewer gets, texts as JSON, frames
/// as blobs.
asio::awaitable<void> ControlServer::serve_watch(Connection connection, proto::OperatorRequest request, Person who) {
    StillMay still([this, who, token = request.token()] { return may_watch(who, token).map([](auto&&) {}); });
    const auto viewer = streams_.add_viewer(*may_watch(who, request.token()));
    if (!viewer) {
        Outcome<Answer> no = tl::unexpected(viewer.error());
        co_return co_await send_answer(connection, request.request(), std::move(no));
    }
    const auto requests = WatchRequest::parse(request.json());
    const auto done = requests ? streams_.watch(**viewer, *requests) : Result<void>(tl::unexpected(requests.error()));
    if (!done) {
        Outcome<Answer> no = walld::refuse(RefusalKind::invalid, done.error().message);
        co_await send_answer(connection, request.request(), std::move(no));
    }
    proto::OperatorReply reply;
    reply.set_request(request.request());
    reply.set_ok(true);
    while (done && connection->is_open() && !stopping_) {
        if (const auto& may = still.at(Clock::now()); !may) {
            log::refused(kHere, peer_name(*connection, who), may.error().message);
            Outcome<Answer> no = tl::unexpected(may.error());
            co_await send_answer(connection, request.request(), std::move(no));
            break;
        }
        const auto message = streams_.next(**viewer);
        if (!message) {
            co_await (*viewer)->news().wait(std::min(still.next(), Clock::now() + kLookAtConnection));
            continue;
        }
        const std::string_view head(message->head), nothing;
        const std::string_view packet = message->packet ? std::string_view(*message->packet) : nothing;
        net::ReplyParts parts(reply, message->binary ? nothing : head, message->binary ? head : nothing, packet);
        co_await send_parts(connection, std::move(parts));
        co_await connection->drained();
    }
    streams_.remove_viewer(**viewer);
}

// ---- time ----

void ControlServer::something_changed() {
    changed_.notify();
    if (std::exchange(tiles_moved_, wall_.tiles_moved()) != wall_.tiles_moved()) streams_.wall_changed(Clock::now());
    streams_.tick(Clock::now());
    if (const auto next = next_deadline(); next < deadline_timer_.expiry()) deadline_timer_.expires_at(next);
}

Clock::time_point ControlServer::next_deadline() const {
    const auto never = Clock::time_point::max();
    return std::min(wall_.next_deadline().value_or(never), streams_.next_deadline().value_or(never));
}

asio::awaitable<void> ControlServer::run_deadlines() {
    while (!stopping_) {
        deadline_timer_.expires_at(next_deadline());
        co_await deadline_timer_.async_wait(net::kTuple);
        wall_.tick(Clock::now());
        streams_.tick(Clock::now());
        changed_.notify();
    }
}

asio::awaitable<void> ControlServer::watch_peers() {
    while (!stopping_) {
        process_timer_.expires_after(kPidCheck);
        co_await process_timer_.async_wait(net::kTuple);
        watch_programs();
        watch_nodes();
    }
}

void ControlServer::watch_programs() {
    std::set<SessionId> quiet;
    for (auto& [id, link] : clients_) {
        if (++link.silent_checks >= kQuietProgram) quiet.insert(id.first);
        const auto pid = link.connection->peer() ? link.connection->peer()->process : 0;
        if (pid <= 0 || ::kill(pid, 0) == 0 || errno != ESRCH) continue;
        log::info("session_orphaned session={} pid={}", id.first.value, pid);
        link.connection->close();
    }
    for (const SessionId id : wall_.note_silent(quiet)) log::warn("session_silent session={}", id.value);
}

void ControlServer::watch_nodes() {
    std::vector<NodeIndex> silent;
    std::set<NodeIndex> quiet;
    for (auto& [node, link] : nodes_) {
        if (++link.silent_checks >= kQuietNode) quiet.insert(node);
        if (link.silent_checks > kSilentChecks) silent.push_back(node);
    }
    for (const NodeIndex node : wall_.note_silent(quiet))
        log::warn("node_silent node={}", log::quoted(wall_.nodes()[node].config->name));
    for (const auto node : silent) {
        nodes_[node].connection->close();  // nobody reads there any more
        drop_node(node, "it has said nothing for " + std::to_string(kSilentChecks * kPidCheck.count()) + " s");
    }
}

}  // namespace wall::walld
