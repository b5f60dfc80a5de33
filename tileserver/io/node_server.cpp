// SPDX-License-Identifier: MIT
#include "tileserver/io/node_server.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>
#include <cstring>
#include <exception>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "common/log/log.h"
#include "common/log/refusals.h"
#include "common/net/as_tuple.h"
#include "common/wire/limits.h"
#include "common/wire/weights.h"
#include "tileserver/io/caps_message.h"
#include "tileserver/io/node_stats.h"
#include "tileserver/io/output_message.h"

namespace wall::tileserver {
namespace {

using namespace std::chrono_literals;

constexpr auto kRetryInterval = 250ms;
constexpr auto kRefusedInterval = 2s;

/// One that is not known is for both.
geom::Eye eye_of(std::uint32_t word) {
    return word <= static_cast<std::uint32_t>(geom::Eye::right) ? static_cast<geom::Eye>(word) : geom::Eye::both;
}

geom::Rect rect_of(const proto::Rect& rect) {
    return {rect.x(), rect.y(), static_cast<std::int32_t>(rect.width()), static_cast<std::int32_t>(rect.height())};
}

/// Two 32-bit values as a payload.
std::array<std::byte, 8> words(std::uint32_t first, std::uint32_t second) {
    std::array<std::byte, 8> bytes{};
    std::memcpy(bytes.data(), &first, 4);
    std::memcpy(bytes.data() + 4, &second, 4);
    return bytes;
}

std::uint64_t microseconds_since_1970() {
    const auto since = std::chrono::system_clock::now().time_since_epoch();
    return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(since).count());
}

/// The node's tiles that are windows; the configuration has them on one display.
WindowRequest window_request(const config::WallConfig& wall, const config::NodeConfig& node) {
    WindowRequest request{{}, wall.background, {}};
    for (const auto& tile : node.tiles) {
        if (!tile.window) continue;
        request.display = tile.window->display;
        request.windows.push_back({tile.slot,
                                   tile.name,
                                   tile.window->monitor,
                                   {tile.window->x, tile.window->y, tile.output.width, tile.output.height},
                                   tile.window->parent});
    }
    return request;
}

/// The node's tiles on monitors without a window system; the configuration has them on one card.
MonitorRequest monitor_request(const config::WallConfig& wall, const config::NodeConfig& node) {
    MonitorRequest request{node.gpu(), wall.background, {}};
    for (const auto& tile : node.tiles) {
        if (!tile.kms) continue;
        MonitorWish wish{tile.slot, tile.name, tile.kms->connector, {}};
        if (const auto& mode = tile.kms->mode) wish.mode = ModeWish{mode->width, mode->height, mode->millihertz};
        request.wishes.push_back(std::move(wish));
    }
    return request;
}

/// A processor has no cache of vertices that would have to be suited.
bool orders_triangles(const config::NodeConfig& node, const GlCaps& caps) {
    return node.triangle_order == config::TriangleOrder::on ||
           (node.triangle_order == config::TriangleOrder::automatic && !is_software(caps));
}

/// What is 0 there is as usual.
SessionQuota quota_of(const proto::Ticket& ticket) {
    SessionQuota out;
    const auto& quota = ticket.quota();
    if (ticket.weight() != 0) out.weight = static_cast<double>(ticket.weight()) / wire::kUsualWeight;
    if (quota.memory() != 0) out.most_bytes = quota.memory();
    if (quota.objects() != 0) out.most_objects = std::min<std::uint64_t>(quota.objects(), kMaxObjects);
    if (quota.fps() != 0) out.frame_interval = std::chrono::nanoseconds(1'000'000'000 / quota.fps());
    out.bytes_per_second = quota.bandwidth();
    return out;
}

/// What wall.toml says, or the same port of all addresses where that would be for this machine alone.
net::Address for_other_machines(const config::NodeConfig& node) {
    const auto& listen = node.listen;
    if (!listen.local()) return listen;
    const auto usual = static_cast<std::uint16_t>(net::kDefaultDataPort + node.part);
    return {.path = {}, .host = "0.0.0.0", .port = listen.is_unix() ? usual : listen.port};
}

}  // namespace

NodeServer::NodeServer(asio::any_io_executor executor, const config::WallConfig& wall, std::string name, NodeKeys keys,
                       Described described)
    : executor_(executor),
      keys_(std::move(keys)),
      walld_(keys_.joined ? keys_.joined->walld : wall.control_listen.front()),
      walld_user_(wall.daemon_user),
      name_(std::move(name)),
      retry_(executor),
      turn_timer_(executor),
      watch_timer_(executor),
      watch_(wall.swap_timeout),
      started_us_(microseconds_since_1970()),
      described_(std::move(described)),
      parts_(executor),
      peer_links_(executor, keys_.tls, [this](SessionId session, NodeIndex to) { not_handed_on(session, to); }),
      tile_streams_(executor, [this](PictureId stream, Parts parts) {
          parts_.send({PartsOf::Kind::stream, stream}, std::move(parts));
      }) {}

NodeServer::~NodeServer() = default;

Result<std::unique_ptr<NodeServer>> NodeServer::open(asio::any_io_executor executor, const config::WallConfig& wall,
                                                     const config::NodeConfig& node, const CompilerHost* compilers,
                                                     NodeKeys keys, Described described) {
    if (auto good = check_partial_codec(node.partial_codec); !good)
        return fail("'partial_codec' of node '" + node.name + "': " + good.error().message);
    const auto peers = keys.tls ? net::Peers::with_keys : net::Peers::of_this_machine;
    const auto address = keys.joined ? for_other_machines(node) : node.listen;
    std::unique_ptr<NodeServer> server(
        new NodeServer(executor, wall, node.name, std::move(keys), std::move(described)));
    server->peer_links_.set_codec(node.partial_codec);
    auto listener = net::Listener::open(executor, address, peers);
    if (!listener) return tl::unexpected(listener.error());
    server->listener_.emplace(std::move(*listener));
    auto render =
        RenderThread::start(BackendChoice(config::name_of(node.backend), node.gpu()), *server,
                            ScreenRequest{window_request(wall, node), monitor_request(wall, node)}, compilers);
    if (!render) return tl::unexpected(render.error());
    server->render_ = std::move(*render);
    server->render_->set_orders_triangles(orders_triangles(node, server->render_->started().caps));
    return server;
}

void NodeServer::start() {
    const auto stopping = [this] { return stopping_; };
    const auto take = [this](net::StreamSocket socket) {
        if (listener_->wants_keys()) net::spawn(executor_, "handshake", take_over_tls(std::move(socket)));
        else take_client(net::Stream(std::move(socket)));
    };
    net::keep_accepting(executor_, *listener_, take, stopping);
    keep("link", &NodeServer::keep_link);
    keep("walld", &NodeServer::watch_walld);
    keep("turns", &NodeServer::watch_turns);
}

void NodeServer::keep(const char* name, asio::awaitable<void> (NodeServer::*work)()) {
    net::keep_running(executor_, {name, [this, work] { return (this->*work)(); }, [this] { return stopping_; }});
}

void NodeServer::stop() {
    stopping_ = true;
    listener_->close();
    retry_.cancel();
    turn_timer_.cancel();
    watch_timer_.cancel();
    if (link_) link_->close();
    peer_links_.close();
    for (const auto& [id, stream] : std::map(streams_)) stream->close();
}

void NodeServer::post(std::function<void()> task) { asio::post(executor_, std::move(task)); }

DataStream* NodeServer::stream(StreamId id) {
    const auto at = streams_.find(id);
    return at == streams_.end() ? nullptr : at->second.get();
}

DataStream* NodeServer::program_stream(SessionId session) {
    for (auto at = streams_.rbegin(); at != streams_.rend(); ++at)
        if (at->second->session() == session && at->second->has_commands()) return at->second.get();
    return nullptr;
}

void NodeServer::end_earlier(const DataStream& stream) {
    for (const auto& [id, earlier] : std::map(streams_)) {
        if (!earlier->is_before(stream)) continue;
        render_->replace_stream(id);
        earlier->close();
    }
}

// ---- clients ----

/// Whoever connects without end keeps only those out who are slower to say who they are: a program shows its ticket in
/// its first bytes, and a connection that does not makes room for it.
void NodeServer::make_room_for_stranger() {
    if (strangers_.size() < most_strangers_) return;
    const StreamId oldest = *strangers_.begin();
    strangers_.erase(strangers_.begin());
    DataStream* silent = stream(oldest);
    if (!silent) return;
    constexpr const char* why = "too many connections that have shown no ticket";
    log::refused(kDataPort, silent->from(), why);
    silent->fail(why);
}

/// Somebody from anywhere; so many may prove their keys at the same time.
asio::awaitable<void> NodeServer::take_over_tls(net::StreamSocket socket) {
    const auto from = net::peer_text(socket.native_handle());
    if (handshakes_ >= kMaxHandshakes) co_return log::refused(kDataPort, from, "too many handshakes at once");
    ++handshakes_;
    auto connection = co_await net::Stream::accept_tls(std::move(socket), *keys_.tls);
    --handshakes_;
    if (stopping_) co_return;
    if (connection) co_return take_client(std::move(*connection));
    log::refused(kDataPort, from, connection.error().message);
}

void NodeServer::take_client(net::Stream connection) {
    make_room_for_stranger();
    const StreamId id(++last_stream_);
    const auto stream = std::make_shared<DataStream>(static_cast<StreamHost&>(*this), id, std::move(connection));
    streams_.emplace(id, stream);
    strangers_.insert(id);
    asio::co_spawn(executor_, stream->run(), [this, id](std::exception_ptr failure) {
        if (!failure) return;
        log::error("stream_failed stream={}", id.value);  // out of memory
        if (DataStream* broken = this->stream(id)) broken->close();
        render_->remove_stream(id);
        stream_closed(id);
    });
}

const Admission* NodeServer::admission(SessionId session) const {
    const auto at = admissions_.find(session);
    return at == admissions_.end() ? nullptr : &at->second;
}

void NodeServer::end_session(SessionId session) {
    admissions_.erase(session);
    shut_out_.forget(session);
    peer_links_.forget(session);
    peers_told_.erase(session);
    render_->remove_session(session);
    for (const auto& [id, stream] : std::map(streams_))
        if (stream->session() == session) stream->close();
}

// ---- turns ----

/// While the driver does not come back nobody draws here, and after some time the watchdog ends the process. Who was
/// drawing is known only now, so it is said now.
asio::awaitable<void> NodeServer::watch_turns() {
    while (!stopping_) {
        turn_timer_.expires_after(turn_watch_.interval());
        co_await turn_timer_.async_wait(net::kTuple);
        const auto turn = render_->running_turn();
        if (turn_watch_.overdue(turn, TurnWatch::Clock::now())) blame(*turn);
    }
}

void NodeServer::blame(const RunningTurn& turn) {
    shut_out_.blame(turn.session, ShutOut::Clock::now());
    fault(turn.stream, turn.session,
          "one call of the driver took longer than " +
              std::to_string(std::chrono::round<std::chrono::milliseconds>(turn_watch_.longest()).count()) +
              " ms; nobody else could draw",
          true);
}

// ---- walld ----

asio::awaitable<Result<std::shared_ptr<net::ControlConnection>>> NodeServer::connect() {
    if (keys_.joined)
        co_return co_await net::ControlConnection::connect_tls(walld_, keys_.tls, keys_.joined->walld_key);
    co_return co_await net::ControlConnection::connect(walld_, walld_user_);
}

asio::awaitable<void> NodeServer::keep_link() {
    while (!stopping_) {
        auto link = co_await connect();
        if (link) {
            said_unreachable_ = false;
            std::exception_ptr failure;
            try {
                co_await use_link(*link);
            } catch (...) {
                failure = std::current_exception();
            }
            drop_link();
            if (failure) std::rethrow_exception(failure);
        } else if (!std::exchange(said_unreachable_, true)) {
            log::warn("walld_unreachable address={} error={}", log::quoted(walld_.text()),
                      log::quoted(link.error().message));
        }
        if (stopping_) break;
        // What an operator has to mend is not tried four times a second.
        retry_.expires_after(std::exchange(refused_, false) ? kRefusedInterval : kRetryInterval);
        co_await retry_.async_wait(net::kTuple);
    }
}

void NodeServer::drop_link() {
    std::exchange(link_, nullptr)->close();
    parts_.use(nullptr);
    peers_told_.clear();
    welcomed_ = false;
    tile_streams_.stop_all(*render_);
    render_->set_coordinated(false);
}

asio::awaitable<void> NodeServer::use_link(std::shared_ptr<net::ControlConnection> link) {
    link_ = link;
    parts_.use(link);
    watch_.linked();
    link->send(hello());
    for (;;) {
        const auto envelope = co_await link->receive();
        if (!envelope) {
            if (!stopping_) log::warn("walld_lost reason={}", log::quoted(envelope.error().message));
            co_return;
        }
        if (watch_.heard()) walld_answers();
        handle(*envelope);
    }
}

/// Frames are shown on the nodes' own account for as long as walld says nothing, as they are while it is away.
asio::awaitable<void> NodeServer::watch_walld() {
    while (!stopping_) {
        watch_timer_.expires_after(watch_.interval());
        co_await watch_timer_.async_wait(net::kTuple);
        peer_links_.end_stuck();
        if (!link_) continue;
        if (link_->is_stuck()) {  // another one is there sooner than TCP asks again
            link_->close();
            continue;
        }
        switch (watch_.tick()) {
            case WalldWatch::Need::nothing: break;
            case WalldWatch::Need::ask: {
                proto::Envelope ping;
                ping.mutable_ping();
                link_->send(ping);
                break;
            }
            case WalldWatch::Need::show_frames:
                if (!welcomed_) break;
                log::warn("walld_silent");
                render_->set_coordinated(false);
                break;
            case WalldWatch::Need::new_link: link_->close(); break;
        }
    }
}

/// walld does not know what was drawn and shown meanwhile.
void NodeServer::walld_answers() {
    if (!welcomed_) return;
    log::info("walld_answers");
    render_->set_coordinated(true);
    render_->report_frames({});
}

proto::Envelope NodeServer::hello() const {
    proto::Envelope envelope;
    auto& hello = *envelope.mutable_node_hello();
    hello.set_version(wire::kProtocolVersion);
    hello.set_name(name_);
    hello.set_address(listener_->address().text());
    if (listener_->wants_keys()) hello.set_key(keys_.tls->fingerprint().bytes());
    hello.set_backend(render_->started().backend);
    hello.set_pid(static_cast<std::uint32_t>(::getpid()));
    hello.set_started_us(started_us_);
    fill_caps(render_->started().caps, *hello.mutable_caps());
    for (const auto& [session, admission] : admissions_) {
        auto& known = *hello.add_sessions();
        known.set_session(session.value);
        known.set_ticket(admission.ticket);
        for (const Rank rank : admission.membership.left) known.add_left(rank);
    }
    *hello.mutable_wall_note() = wall_note_;
    return envelope;
}

void NodeServer::handle(const proto::Envelope& envelope) {
    using Case = proto::Envelope::MessageCase;
    switch (envelope.message_case()) {
        case Case::kNodeWelcome: return welcome(envelope.node_welcome());
        case Case::kTicket: return admit(envelope.ticket());
        case Case::kPeers: return set_peers(envelope.peers());
        case Case::kSessionEnd: return end_session(SessionId(envelope.session_end().session()));
        case Case::kPresent:
            return render_->present(SessionId(envelope.present().session()), SurfaceId(envelope.present().surface()),
                                    envelope.present().frame());
        case Case::kStacking: return set_stacking(envelope.stacking());
        case Case::kPong: return;
        case Case::kWallNote: wall_note_ = envelope.wall_note(); return;
        case Case::kFramesRequest: return render_->report_frames(SessionId(envelope.frames_request().session()));
        case Case::kTilePattern:
            return render_->set_pattern(envelope.tile_pattern().slot(), pattern_of(envelope.tile_pattern()));
        case Case::kSnapshotRequest: {
            const auto& request = envelope.snapshot_request();
            return render_->request_picture({.id = PictureId(request.request()),
                                             .slot = request.slot(),
                                             .session = SessionId(request.session()),
                                             .output = request.output()});
        }
        case Case::kStreamStart: return tile_streams_.start(*render_, envelope.stream_start());
        case Case::kStreamStop: return tile_streams_.stop(*render_, PictureId(envelope.stream_stop().stream()));
        case Case::kStreamReady: return tile_streams_.ready(*render_, envelope.stream_ready());
        case Case::kWallDescription:
            starts_anew_ = starts_anew_ || (described_ && described_(envelope.wall_description().wall_toml()));
            return;
        case Case::kRefused:
            refused_ = true;
            log::error("walld_refused reason={}", log::quoted(envelope.refused().reason()));
            return;
        default: log::warn("walld_unexpected_message number={}", static_cast<int>(envelope.message_case()));
    }
}

void NodeServer::set_stacking(const proto::Stacking& stacking) {
    std::vector<Stacked> now;
    for (const auto& entry : stacking.entries())
        now.push_back({{SessionId(entry.session()), SurfaceId(entry.surface())}, entry.held()});
    std::erase_if(stacking_, [&](const Stacked& old) {
        return std::ranges::count(stacking.returning(), old.window.session.value) == 0 ||
               std::ranges::count(now, old.window, &Stacked::window) > 0;
    });
    stacking_.insert(stacking_.end(), now.begin(), now.end());
    std::vector<StackEntry> entries, held;
    for (const auto& [window, is_held] : stacking_) {
        entries.push_back(window);
        if (is_held) held.push_back(window);
    }
    std::vector<SessionId> returning;
    for (const auto session : stacking.returning()) returning.emplace_back(session);
    render_->set_stacking(std::move(entries), std::move(held), returning);
}

void NodeServer::admit(const proto::Ticket& ticket) {
    const auto known = admissions_.find(SessionId(ticket.session()));
    // A number that another walld has given to another program.
    if (known != admissions_.end() && known->second.ticket != ticket.ticket()) end_session(SessionId(ticket.session()));
    const auto members = std::min(ticket.members(), wire::kMaxMembers);
    const auto quota = quota_of(ticket);
    admissions_[SessionId(ticket.session())] = {ticket.ticket(),
                                                {members, {ticket.left().begin(), ticket.left().end()}},
                                                ticket.key(),
                                                {ticket.peer_keys().begin(), ticket.peer_keys().end()},
                                                quota};
    render_->set_quota(SessionId(ticket.session()), quota);
}

void NodeServer::set_peers(const proto::Peers& peers) {
    std::map<NodeIndex, Peer> nodes;
    for (const auto& node : peers.nodes()) {
        auto address = net::Address::parse(node.address());
        const auto key = tls::Fingerprint::from_bytes(node.key());
        if (!address || (!key && !node.key().empty())) continue;
        nodes.emplace(NodeIndex(node.node()),
                      Peer{std::move(*address), node.ticket(), key ? std::optional(*key) : std::nullopt});
    }
    std::set<NodeIndex> there;
    for (const auto& node : peers.nodes()) there.insert(NodeIndex(node.node()));
    // A walld that has started again hears of nodes one after the other.
    const auto before = std::exchange(peers_told_[SessionId(peers.session())], there);
    if (DataStream* program = program_stream(SessionId(peers.session())))
        program->miss_parcels([&](NodeIndex from) { return before.contains(from) && !there.contains(from); });
    render_->set_partial_nodes(SessionId(peers.session()), std::move(there));
    peer_links_.set_peers(SessionId(peers.session()), std::move(nodes));
}

void NodeServer::lose_parcels(SessionId session, NodeIndex from) {
    if (DataStream* program = program_stream(session))
        program->miss_parcels([from](NodeIndex of) { return of == from; });
}

/// The program, which has a stream to here, sends it anew to those that wait for it.
void NodeServer::not_handed_on(SessionId session, NodeIndex to) {
    log::warn("not_handed_on session={} to={}", session.value, to.value);
    if (DataStream* program = program_stream(session))
        program->send(wire::FrameKind::not_handed_on, std::as_bytes(std::span(&to.value, 1)));
}

void NodeServer::welcome(const proto::NodeWelcome& welcome) {
    std::vector<Tile> tiles;
    for (const auto& tile : welcome.tiles()) {
        tiles.push_back({.slot = tile.slot(), .rect = rect_of(tile.rect()), .eye = eye_of(tile.eye())});
        if (!tile.has_output()) continue;
        if (auto output = output_of(tile.output())) tiles.back().output = std::move(*output);
        else
            log::error("output_unusable tile={} reason={}", log::quoted(tile.name()),
                       log::quoted(output.error().message));
    }
    log::info("walld_welcome node={} tiles={}", welcome.node(), tiles.size());
    render_->set_tiles(std::move(tiles), welcome.background(), welcome.tiles_version());
    render_->measure_tiles(welcome.measure_tiles());
    render_->set_coordinated(true);
    welcomed_ = true;
}

void NodeServer::to_walld(const proto::Envelope& envelope) {
    if (link_) link_->send(envelope);
}

// ---- the render thread's reports ----

void NodeServer::reply(StreamId id, RequestId request, std::vector<std::byte> answer) {
    answer.insert(answer.begin(), 4, std::byte{});
    std::memcpy(answer.data(), &request, sizeof request);
    post([this, id, answer = std::move(answer)] {
        if (DataStream* to = stream(id)) to->send(wire::FrameKind::reply, answer);
    });
}

void NodeServer::drawn(StreamId id, SurfaceId surface, std::uint32_t frame) {
    post([=, this] {
        if (DataStream* to = stream(id)) to->send(wire::FrameKind::swap_done, words(surface.value, frame));
    });
}

void NodeServer::rendered(SessionId session, SurfaceId surface, std::uint32_t frame) {
    post([=, this] {
        if (watch_.silent()) return;  // it is told where we are when it answers
        proto::Envelope envelope;
        auto& rendered = *envelope.mutable_rendered();
        rendered.set_session(session.value);
        rendered.set_surface(surface.value);
        rendered.set_frame(frame);
        to_walld(envelope);
    });
}

void NodeServer::frames(SessionId session, SurfaceId surface, std::uint32_t drawn, std::uint32_t shown) {
    post([=, this] {
        proto::Envelope envelope;
        auto& rendered = *envelope.mutable_rendered();
        rendered.set_session(session.value);
        rendered.set_surface(surface.value);
        rendered.set_frame(drawn);
        rendered.set_shown(shown);
        to_walld(envelope);
    });
}

void NodeServer::failed(StreamId id, SessionId session, std::string reason) {
    post([this, id, session, reason = std::move(reason)] { fault(id, session, reason, false); });
}

void NodeServer::fault(StreamId id, SessionId session, const std::string& reason, bool ends) {
    log::warn("session_fault stream={} session={} reason={}", id.value, session.value, log::quoted(reason));
    if (DataStream* to = stream(id)) to->fail(reason);
    proto::Envelope envelope;
    auto& fault = *envelope.mutable_session_fault();
    fault.set_session(session.value);
    fault.set_reason(reason);
    fault.set_ends(ends);
    to_walld(envelope);
}

void NodeServer::ended(StreamId id, std::string reason) {
    post([this, id, reason = std::move(reason)] {
        if (DataStream* to = stream(id)) to->fail(reason);
    });
}

void NodeServer::picture(Picture picture) {
    post([this, picture = std::move(picture)]() mutable {
        const auto id = picture.request.id;
        if (picture.request.stream) tile_streams_.picture(std::move(picture));
        else parts_.send({PartsOf::Kind::snapshot, id}, snapshot_parts(std::move(picture)));
    });
}

void NodeServer::partial(SessionId session, NodeIndex to, std::vector<std::byte> message) {
    post([this, session, to, message = std::move(message)]() mutable {
        peer_links_.send_partial(session, to, std::move(message));
    });
}

void NodeServer::tiles_taken(std::uint32_t version) {
    post([=, this] {
        proto::Envelope envelope;
        envelope.mutable_tiles_taken()->set_tiles_version(version);
        to_walld(envelope);
    });
}

void NodeServer::stats(const RenderStats& stats) {
    post([this, stats] {
        last_stats_ = std::chrono::steady_clock::now();
        proto::Envelope envelope;
        auto& out = *envelope.mutable_node_stats();
        out.set_bytes_received(bytes_received_);
        out.set_bytes_handed_on(peer_links_.bytes_handed_on());
        out.set_time_us(microseconds_since_1970());
        fill_stats(stats, out);
        std::map<std::string, std::uint32_t> transports;
        for (const auto& [id, stream] : streams_)
            if (*stream->transport() != '\0') ++transports[stream->transport()];
        for (const auto& [name, streams] : transports) {
            auto& transport = *out.add_transports();
            transport.set_name(name);
            transport.set_streams(streams);
        }
        tile_streams_.fill_stats(out);
        to_walld(envelope);
        if (burst_.tick(bytes_received_)) give_memory_back();
        for (const auto& [id, stream] : streams_) stream->miss_parcels({});
    });
}

/// To the system.
void NodeServer::give_memory_back() {
    for (const auto& [id, stream] : streams_) stream->forget_spares();
    ::malloc_trim(0);
}

void NodeServer::scaled(const ScaledTile& tile) {
    post([tile] {
        log::warn("tile_scaled tile={} size={}x{} window={}x{}", log::quoted(tile.tile), tile.width, tile.height,
                  tile.screen_width, tile.screen_height);
    });
}

void NodeServer::monitor(const MonitorNews& news) {
    post([news] {
        if (news.mode.empty())
            log::warn("monitor_dark tile={} connector={} monitor={} reason={}", log::quoted(news.tile),
                      log::quoted(news.connector), log::quoted(news.monitor), log::quoted(news.note));
        else
            log::info("monitor_shows tile={} connector={} monitor={} mode={} note={}", log::quoted(news.tile),
                      log::quoted(news.connector), log::quoted(news.monitor), log::quoted(news.mode),
                      log::quoted(news.note));
    });
}

void NodeServer::output_lost(std::string reason) {
    post([this, reason = std::move(reason)]() mutable { failure_ = std::move(reason); });
}

}  // namespace wall::tileserver
