// SPDX-License-Identifier: MIT
// walld's model of the wall, to which nodes and programs say whatever they like and as often: it stays consistent
// enough to be shown, and to be told more. Input: (kind:u8 who:u8 length:u16 message)*, a message of control.proto
// each.
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/assert.h"
#include "common/config/load_config.h"
#include "common/wire/limits.h"
#include "tests/fuzz/input_pieces.h"
#include "tests/support/small_wall.h"
#include "walld/wall/messages.h"
#include "walld/wall/status.h"

namespace {

using namespace wall;
using namespace wall::walld;

constexpr std::size_t kMostPrograms = 8;
constexpr Rank kMostRanks = 2;

using Client = std::pair<SessionId, Rank>;

/// What the control server does of it (control_server.cpp): who is there, and whom it cuts off.
class Shell final : public Outbox {
public:
    Shell() : wall_(two_nodes(), *this, [this](std::size_t n) { return std::string(n, ++random_); }) {}

    void say(std::uint8_t kind, std::uint8_t who, std::string_view bytes) {
        ++clock_;
        constexpr auto kCount = std::size(kSay);
        (this->*kSay[kind % kCount])(who, bytes);
        for (const SessionId gone : std::exchange(cut_off_, {}))
            std::erase_if(clients_, [gone](const Client& c) { return c.first == gone; });
    }
    void check() {
        (void)dump(status_json(wall_, clock_));
        for (const auto& [session, rank] : clients_) WALL_ASSERT(wall_.sessions().contains(session));
        for (const SurfaceKey& key : wall_.stacking()) WALL_ASSERT(wall_.find(key) != nullptr);
    }

    void to_node(NodeIndex node, const proto::Envelope&) override { WALL_ASSERT(node.value < wall_.nodes().size()); }
    void to_client(SessionId, const proto::Envelope& message) override { WALL_ASSERT(message.ByteSizeLong() > 0); }
    void to_member(SessionId, Rank, const proto::Envelope& message) override {
        WALL_ASSERT(message.ByteSizeLong() > 0);
    }
    void end_session(SessionId session, const std::string&) override { cut_off_.insert(session); }

private:
    static config::WallConfig two_nodes() { return *config::parse_config(kTwoNodes, "fuzz"); }

    template <class Message, class Do>
    void with(std::string_view bytes, Do&& act) {
        Message message;
        if (message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) act(message);
    }
    /// A message of a program that is there.
    template <class Message, class Do>
    void of_client(std::uint8_t who, std::string_view bytes, Do&& act) {
        if (clients_.empty()) return;
        const Client client = *std::next(clients_.begin(), who % static_cast<std::ptrdiff_t>(clients_.size()));
        with<Message>(bytes, [&](const Message& message) { act(client.first, client.second, message); });
    }
    /// And of a node.
    template <class Message, class Do>
    void of_node(std::uint8_t who, std::string_view bytes, Do&& act) {
        const NodeIndex node(who % 2u);
        if (nodes_.contains(node)) with<Message>(bytes, [&](const Message& message) { act(node, message); });
    }

    void node_comes(std::uint8_t who, std::string_view bytes) {
        with<proto::NodeHello>(bytes, [&](proto::NodeHello& hello) {
            hello.set_version(wire::kProtocolVersion);
            hello.set_name(who % 2 == 0 ? "left" : "right");
            const auto index = wall_.check_node(hello);
            if (!index) return;
            if (nodes_.erase(*index) != 0) wall_.node_leaves(*index, clock_, true);
            nodes_.insert(*index);
            WALL_ASSERT(wall_.node_joins(hello, clock_));
        });
    }
    void node_goes(std::uint8_t who, std::string_view) {
        if (nodes_.erase(NodeIndex(who % 2u)) != 0) wall_.node_leaves(NodeIndex(who % 2u), clock_, (who & 2) != 0);
    }
    void rendered(std::uint8_t who, std::string_view bytes) {
        of_node<proto::Rendered>(who, bytes,
                                 [&](NodeIndex node, const auto& m) { wall_.node_rendered(node, m, clock_); });
    }
    void reports(std::uint8_t who, std::string_view bytes) {
        of_node<proto::NodeStats>(who, bytes, [&](NodeIndex node, const auto& m) { wall_.node_reports(node, m); });
    }
    void faults(std::uint8_t who, std::string_view bytes) {
        of_node<proto::SessionFault>(who, bytes, [&](NodeIndex node, const auto& m) { wall_.node_faults(node, m); });
    }
    void program_comes(std::uint8_t who, std::string_view bytes) {
        with<proto::ClientHello>(bytes, [&](proto::ClientHello& hello) {
            hello.set_version(wire::kProtocolVersion);
            if (hello.has_group()) hello.mutable_group()->set_rank(who % kMostRanks);
            const Person person{Person::Kind::unix_user, "somebody", 1, Role::user};
            if (clients_.size() >= kMostPrograms || !wall_.check(hello) || !wall_.check_quota(hello, person) ||
                !wall_.check_member(hello, person) || !wall_.any_node_up() ||
                wall_.comeback(hello, clock_) != Wall::Comeback::may_come)
                return;
            const Rank rank = hello.group().rank();
            wall_.open_session(hello, person, clock_, [&](SessionId id) { clients_.insert({id, rank}); });
        });
    }
    void program_goes(std::uint8_t who, std::string_view bytes) {
        of_client<proto::Envelope>(who, bytes, [&](SessionId id, Rank rank, const auto&) {
            clients_.erase({id, rank});
            if ((who & 128) != 0) wall_.await_again(id, rank, clock_);
            else (void)wall_.member_gone(id, rank);
        });
    }
    void opens(std::uint8_t who, std::string_view bytes) {
        of_client<proto::SurfaceOpen>(who, bytes, [&](SessionId id, Rank rank, const auto& m) {
            if (wall_.open_surface(id, m, clock_, rank)) return;
            clients_.erase({id, rank});
            (void)wall_.member_gone(id, rank);
        });
    }
    void resizes(std::uint8_t who, std::string_view bytes) {
        of_client<proto::SurfaceResize>(
            who, bytes, [&](SessionId id, Rank rank, const auto& m) { wall_.resize_surface(id, m, rank); });
    }
    void adopts(std::uint8_t who, std::string_view bytes) {
        of_client<proto::SurfaceAdopted>(
            who, bytes, [&](SessionId id, Rank, const auto& m) { wall_.adopt_placement(id, m, clock_); });
    }
    void client_reports(std::uint8_t who, std::string_view bytes) {
        of_client<proto::ClientStats>(
            who, bytes, [&](SessionId id, Rank rank, const auto& m) { wall_.client_reports(id, rank, m, clock_); });
    }
    void closes(std::uint8_t who, std::string_view bytes) {
        of_client<proto::SurfaceClose>(who, bytes, [&](SessionId id, Rank rank, const auto& m) {
            if ((who & 128) != 0) wall_.cannot_close(id, SurfaceId(m.surface()));
            else wall_.close_surface(id, SurfaceId(m.surface()), rank);
        });
    }
    void notes(std::uint8_t who, std::string_view bytes) {
        of_client<proto::PlacementNoted>(
            who, bytes, [&](SessionId id, Rank rank, const auto& m) { wall_.placement_noted(id, rank, m); });
    }
    void leaves(std::uint8_t who, std::string_view bytes) {
        of_client<proto::Envelope>(who, bytes,
                                   [&](SessionId id, Rank rank, const auto&) { wall_.member_leaves(id, rank); });
    }
    void time_passes(std::uint8_t who, std::string_view) {
        clock_ += std::chrono::milliseconds(who * who);
        wall_.tick(clock_);
    }
    void is_operated(std::uint8_t who, std::string_view bytes) {
        of_client<proto::Rect>(who, bytes, [&](SessionId id, Rank, const auto& m) {
            const Target all{id, {}};
            (void)wall_.place_surface(all, from_proto(m));
            (void)(who % 2 == 0 ? wall_.raise(all) : wall_.lower(all));
            (void)wall_.hold(all, who % 3 == 0, clock_);
            (void)wall_.step(all, 1, clock_);
            (void)wall_.load_layout(wall_.current_layout());
        });
    }

    using Say = void (Shell::*)(std::uint8_t who, std::string_view bytes);
    static const Say kSay[16];

    std::set<Client> clients_;
    std::set<NodeIndex> nodes_;
    std::set<SessionId> cut_off_;
    walld::Clock::time_point clock_{std::chrono::hours(1)};
    char random_ = 0;
    Wall wall_;
};

const Shell::Say Shell::kSay[16] = {
    &Shell::node_comes, &Shell::node_goes,     &Shell::rendered,       &Shell::reports,
    &Shell::faults,     &Shell::program_comes, &Shell::program_goes,   &Shell::opens,
    &Shell::resizes,    &Shell::adopts,        &Shell::client_reports, &Shell::closes,
    &Shell::notes,      &Shell::leaves,        &Shell::time_passes,    &Shell::is_operated};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::InputPieces input(data, size);
    Shell shell;
    while (!input.empty()) {
        const std::uint8_t kind = input.byte(), who = input.byte();
        shell.say(kind, who, input.counted());
        shell.check();
    }
    return 0;
}
