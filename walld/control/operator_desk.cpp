// SPDX-License-Identifier: MIT
#include "walld/control/operator_desk.h"

#include <algorithm>
#include <array>
#include <boost/asio/this_coro.hpp>

#include "common/base/stereo.h"
#include "common/log/log.h"
#include "common/net/base64.h"
#include "walld/control/arguments.h"
#include "walld/control/audit.h"
#include "walld/streams/pattern_label.h"
#include "walld/streams/stream_status.h"
#include "walld/wall/status.h"

namespace wall::walld {
namespace {

using nlohmann::json;

constexpr std::int64_t kMaxWait = 600'000;             // ms
constexpr auto kMoveLimit = std::chrono::seconds(30);  // more than a program takes to say why it stays
constexpr auto kComesBack = std::chrono::seconds(3);

Outcome<Target> target_of(const Asked& asked) {
    return text_of(asked.arguments, "id").and_then([](const std::string& text) { return Target::parse(text); });
}
Outcome<std::string> name_of(const Asked& asked) { return text_of(asked.arguments, "name"); }

constexpr std::int64_t kMostBit = 14;  // of a column or row: no tile has more than 32768

Outcome<proto::TilePattern> pattern_of(const json& arguments) {
    constexpr std::array<std::pair<const char*, proto::TilePattern::Kind>, 7> kKinds{
        {{"off", proto::TilePattern::NONE},
         {"grid", proto::TilePattern::GRID},
         {"ramps", proto::TilePattern::RAMPS},
         {"names", proto::TilePattern::NAMES},
         {"white", proto::TilePattern::WHITE},
         {"black", proto::TilePattern::BLACK},
         {"code", proto::TilePattern::CODE}}};
    const auto kind = text_of(arguments, "kind"), axis = text_of(arguments, "axis");
    const auto bit = number_of(arguments, "bit", 0, 0, kMostBit);
    const auto output = flag_of(arguments, "output", false), inverted = flag_of(arguments, "inverted", false);
    if (!kind) return tl::unexpected(kind.error());
    if (!axis) return tl::unexpected(axis.error());
    if (!bit) return tl::unexpected(bit.error());
    if (!output) return tl::unexpected(output.error());
    if (!inverted) return tl::unexpected(inverted.error());
    const auto found = std::ranges::find(kKinds, *kind, [](const auto& entry) { return std::string(entry.first); });
    if (found == kKinds.end())
        return refuse(RefusalKind::invalid,
                      "'kind' is '" + *kind + "': expected grid, ramps, names, white, black, code or off");
    if (!axis->empty() && *axis != "x" && *axis != "y")
        return refuse(RefusalKind::invalid, "'axis' is '" + *axis + "': expected x or y");
    proto::TilePattern out;
    out.set_kind(found->second);
    out.set_on_output(*output);
    out.set_bit(static_cast<std::uint32_t>(*bit));
    out.set_rows(*axis == "y");
    out.set_inverted(*inverted);
    return out;
}

void add_label(proto::TilePattern& pattern, const config::NodeConfig& node, const config::TileConfig& tile) {
    const auto& rect = tile.rect;
    auto label = pattern_label({tile.name, "node " + node.name,
                                std::to_string(rect.width) + "x" + std::to_string(rect.height) + "+" +
                                    std::to_string(rect.x) + "+" + std::to_string(rect.y)});
    pattern.set_label_width(label.width);
    pattern.set_label_height(label.height);
    pattern.set_label(std::move(label.bytes));
}

Answer done() { return {}; }
Answer as_answer(json content) { return {std::move(content), {}}; }

}  // namespace

const OperatorDesk::Row OperatorDesk::kVerbs[] = {
    {"status", Need::look, &OperatorDesk::status},
    {"nodes", Need::look, &OperatorDesk::nodes},
    {"tiles", Need::look, &OperatorDesk::tiles},
    {"sessions", Need::look, &OperatorDesk::sessions},
    {"session", Need::look, &OperatorDesk::session},
    {"streams", Need::look, &OperatorDesk::streams},
    {"whoami", Need::look, &OperatorDesk::whoami},
    {"wait", Need::look, &OperatorDesk::wait},
    {"screenshot", Need::look, &OperatorDesk::screenshot},
    {"layouts", Need::look, &OperatorDesk::layouts},
    {"layout", Need::look, &OperatorDesk::layout},
    {"place", Need::own, &OperatorDesk::place},
    {"raise", Need::own, &OperatorDesk::raise},
    {"lower", Need::own, &OperatorDesk::lower},
    {"close", Need::own, &OperatorDesk::close},
    {"hold", Need::own, &OperatorDesk::hold},
    {"step", Need::own, &OperatorDesk::step},
    {"weight", Need::operate, &OperatorDesk::weight},
    {"stereo", Need::own, &OperatorDesk::stereo},
    {"move", Need::own, &OperatorDesk::move},
    {"record", Need::own, &OperatorDesk::record},
    {"pattern", Need::operate, &OperatorDesk::pattern},
    {"save_layout", Need::operate, &OperatorDesk::save_layout},
    {"load_layout", Need::operate, &OperatorDesk::load_layout},
    {"delete_layout", Need::operate, &OperatorDesk::delete_layout},
    {"machines", Need::operate, &OperatorDesk::machines},
    {"join_token", Need::operate, &OperatorDesk::join_token},
    {"revoke", Need::operate, &OperatorDesk::revoke},
    {"tokens", Need::operate, &OperatorDesk::tokens},
    {"revoke_token", Need::operate, &OperatorDesk::revoke_token},
    {"reload", Need::operate, &OperatorDesk::reload},
    {"add_node", Need::operate, &OperatorDesk::add_node},
    {"remove_node", Need::operate, &OperatorDesk::remove_node},
    {"drain_node", Need::operate, &OperatorDesk::drain_node},
    {"undrain_node", Need::operate, &OperatorDesk::undrain_node},
};

asio::awaitable<Outcome<Answer>> OperatorDesk::carry_out(Asked asked) {
    const auto row = row_of(asked);
    if (!row) co_return tl::unexpected(row.error());
    // An `if`, because GCC 12 destroys the temporaries of `?:` around a co_await twice.
    Outcome<Answer> answer;
    const auto there = co_await wait_for_session(asked);
    const auto permitted = there ? allowed(**row, asked) : there;
    if (permitted) answer = co_await (this->*(*row)->run)(asked);
    else answer = tl::unexpected(permitted.error());
    if ((*row)->need != Need::look || (!answer && answer.error().kind == RefusalKind::forbidden))
        log::info("{}", log::plain(audit_line(
                            {asked.who, asked.via, asked.verb, asked.arguments, answer ? nullptr : &answer.error()})));
    changed_.notify();
    co_return answer;
}

Outcome<const OperatorDesk::Row*> OperatorDesk::row_of(const Asked& asked) const {
    if (!asked.arguments.is_object()) return refuse(RefusalKind::invalid, "arguments: expected a JSON object");
    const auto found = std::ranges::find_if(kVerbs, [&](const Row& row) { return asked.verb == row.name; });
    if (found == std::end(kVerbs)) return refuse(RefusalKind::invalid, "unknown verb '" + asked.verb + "'");
    return &*found;
}

/// What is asked of a program whose link was lost just now is carried out when it is back.
asio::awaitable<Outcome<void>> OperatorDesk::wait_for_session(const Asked& asked) {
    if (!asked.arguments.contains("id")) co_return Outcome<void>{};
    const auto target = target_of(asked);
    if (!target) co_return Outcome<void>{};  // the verb says what is wrong with it
    const auto until = Clock::now() + kComesBack;
    while (wall_.awaits(target->session)) {
        if (Clock::now() >= until)
            co_return refuse(RefusalKind::unavailable,
                             "session " + std::to_string(target->session.value) +
                                 " is away: the link to its program is lost, and walld waits for it to come again");
        co_await changed_.wait(until);
    }
    co_return Outcome<void>{};
}

/// Whether something exists is no secret: everybody who may ask for it sees all sessions.
Outcome<void> OperatorDesk::allowed(const Row& row, const Asked& asked) const {
    if (row.need != Need::own) return may(asked.who, row.need, asked.verb, nullptr);
    const auto target = target_of(asked);
    if (!target) return tl::unexpected(target.error());
    const auto found = wall_.sessions().find(target->session);
    const auto* owner = found == wall_.sessions().end() ? nullptr : &found->second.owner;
    const auto what = asked.verb + " session " + std::to_string(target->session.value);
    if (owner || asked.who.role < Role::user) return may(asked.who, row.need, what, owner);
    return refuse(RefusalKind::not_found, "there is no session " + std::to_string(target->session.value));
}

asio::awaitable<Outcome<Answer>> OperatorDesk::status(const Asked&) {
    auto status = status_json(wall_, Clock::now());
    status["streams"] = streams_json(wall_, streams_.views());
    status["page"] = page_;
    const auto time = std::chrono::system_clock::now().time_since_epoch();
    status["time_ms"] = std::chrono::duration_cast<std::chrono::milliseconds>(time).count();
    co_return Answer{std::move(status), {}};
}
asio::awaitable<Outcome<Answer>> OperatorDesk::streams(const Asked&) {
    co_return Answer{streams_json(wall_, streams_.views()), {}};
}
asio::awaitable<Outcome<Answer>> OperatorDesk::nodes(const Asked&) { co_return Answer{nodes_json(wall_), {}}; }
asio::awaitable<Outcome<Answer>> OperatorDesk::tiles(const Asked&) {
    co_return Answer{tiles_json(wall_, Clock::now()), {}};
}
asio::awaitable<Outcome<Answer>> OperatorDesk::sessions(const Asked&) { co_return Answer{sessions_json(wall_), {}}; }
asio::awaitable<Outcome<Answer>> OperatorDesk::whoami(const Asked& asked) {
    co_return Answer{person_json(asked.who), {}};
}

asio::awaitable<Outcome<Answer>> OperatorDesk::session(const Asked& asked) {
    co_return target_of(asked).and_then([&](const Target& target) {
        return wall_.surfaces_of(target).map([&](const auto&) {
            return Answer{session_json(wall_, target.session), {}};
        });
    });
}

asio::awaitable<Outcome<Answer>> OperatorDesk::place(const Asked& asked) {
    const auto rect = rect_of(asked.arguments, "rect");
    if (!rect) co_return tl::unexpected(rect.error());
    co_return target_of(asked)
        .and_then([&](const Target& target) { return wall_.place_surface(target, *rect); })
        .map(done);
}

asio::awaitable<Outcome<Answer>> OperatorDesk::raise(const Asked& asked) {
    co_return target_of(asked).and_then([&](const Target& target) { return wall_.raise(target); }).map(done);
}

asio::awaitable<Outcome<Answer>> OperatorDesk::lower(const Asked& asked) {
    co_return target_of(asked).and_then([&](const Target& target) { return wall_.lower(target); }).map(done);
}

/// Asks the program, as a window manager would; one that does not obey in time, or cannot be asked, is cut off. A
/// window that is one of several is only asked for.
asio::awaitable<Outcome<Answer>> OperatorDesk::close(const Asked& asked) {
    const auto target = target_of(asked);
    const auto keys = target.and_then([&](const Target& t) { return wall_.ask_to_close(t); });
    if (!keys) co_return tl::unexpected(keys.error());
    const auto open = [&](const SurfaceKey& key) { return wall_.find(key) != nullptr; };
    const auto obeyed = [&] {
        return target->surface ? std::ranges::none_of(*keys, open) : !wall_.sessions().contains(target->session);
    };
    const auto deaf = [&] {
        return std::ranges::all_of(*keys,
                                   [&](const SurfaceKey& key) { return open(key) && wall_.find(key)->cannot_close; });
    };
    const auto until = Clock::now() + wall_.config().close_timeout;
    while (!obeyed() && !deaf() && Clock::now() < until) co_await changed_.wait(until);
    if (obeyed()) co_return Answer{{{"closed", "by the program"}}, {}};
    if (target->surface && wall_.sessions().at(target->session).surfaces.size() > 1) {
        co_return refuse(RefusalKind::conflict,
                         "the program keeps this window open; close the session to take all of it from the wall");
    }
    end_session_(target->session, "closed by an operator");
    co_return Answer{{{"closed", "by walld"}}, {}};
}

asio::awaitable<Outcome<Answer>> OperatorDesk::hold(const Asked& asked) {
    const auto on = flag_of(asked.arguments, "on", true);
    if (!on) co_return tl::unexpected(on.error());
    co_return target_of(asked)
        .and_then([&](const Target& target) { return wall_.hold(target, *on, Clock::now()); })
        .map(done);
}

asio::awaitable<Outcome<Answer>> OperatorDesk::step(const Asked& asked) {
    const auto frames = number_of(asked.arguments, "frames", 1, 1, INT32_MAX);
    if (!frames) co_return tl::unexpected(frames.error());
    co_return target_of(asked)
        .and_then(
            [&](const Target& target) { return wall_.step(target, static_cast<std::uint32_t>(*frames), Clock::now()); })
        .map(done);
}

asio::awaitable<Outcome<Answer>> OperatorDesk::weight(const Asked& asked) {
    const auto weight = number_of(asked.arguments, "weight", 0, 1, wire::kMostWeight);
    if (!weight) co_return tl::unexpected(weight.error());
    co_return target_of(asked)
        .and_then([&](const Target& target) { return wall_.set_weight(target, static_cast<std::uint32_t>(*weight)); })
        .map(done);
}

/// Percents of the window's width and the program's units, as people say them.
asio::awaitable<Outcome<Answer>> OperatorDesk::stereo(const Asked& asked) {
    constexpr double kPercent = 100, kMostPercent = kMostSeparation * kPercent;
    const auto on = flag_of(asked.arguments, "on", true);
    if (!on) co_return tl::unexpected(on.error());
    const auto percent =
        real_of(asked.arguments, "separation", kUsualSeparation * kPercent, -kMostPercent, kMostPercent);
    if (!percent) co_return tl::unexpected(percent.error());
    const auto distance = real_of(asked.arguments, "distance", 0, 0, kFarthestScreen);
    if (!distance) co_return tl::unexpected(distance.error());
    proto::Stereo stereo;
    stereo.set_separation(static_cast<float>(*percent / kPercent));
    stereo.set_screen(static_cast<float>(*distance));
    co_return target_of(asked)
        .and_then(
            [&](const Target& target) { return wall_.set_stereo(target, *on ? std::optional(stereo) : std::nullopt); })
        .map(done);
}

/// Answers when the program is on the other wall, or says why it stays.
asio::awaitable<Outcome<Answer>> OperatorDesk::move(const Asked& asked) {
    const auto to = text_of(asked.arguments, "to");
    if (!to) co_return tl::unexpected(to.error());
    if (!to->starts_with("unix:"))
        co_return refuse(RefusalKind::invalid,
                         "to: expected the other wall's control socket on the program's machine, "
                         "such as unix:/run/wallgl/control.sock, got '" +
                             *to + "'");
    const auto target = target_of(asked);
    if (!target) co_return tl::unexpected(target.error());
    const SessionId session = target->session;
    if (const auto told = wall_.ask_to_move(*target, *to); !told) co_return tl::unexpected(told.error());
    for (const auto until = Clock::now() + kMoveLimit;;) {
        if (const auto why = wall_.take_move_answer(session)) {
            if (why->empty()) co_return Answer{{{"moved", *to}}, {}};
            co_return refuse(RefusalKind::conflict, "the program stays: " + *why);
        }
        if (!wall_.sessions().contains(session))
            co_return refuse(RefusalKind::not_found, "the program has ended before it could move");
        if (Clock::now() >= until)
            co_return refuse(RefusalKind::unavailable, "the program has not answered; it may be stopped");
        co_await changed_.wait(until);
    }
}

asio::awaitable<Outcome<Answer>> OperatorDesk::record(const Asked& asked) {
    const auto address = text_of(asked.arguments, "address");
    if (!address) co_return tl::unexpected(address.error());
    co_return target_of(asked)
        .and_then([&](const Target& target) { return wall_.begin_recording(target.session, *address); })
        .map([](const std::string& ticket) {
            return as_answer({{"ticket", net::to_base64(ticket)}});
        });
}

Outcome<void> OperatorDesk::permits(const Asked& asked) const {
    return row_of(asked).and_then([&](const Row* row) { return allowed(*row, asked); });
}

/// Answers when the frame is shown on all tiles. The session may still be about to open its window.
asio::awaitable<Outcome<Answer>> OperatorDesk::wait(const Asked& asked) {
    const auto target = target_of(asked);
    if (!target) co_return tl::unexpected(target.error());
    const auto frame = number_of(asked.arguments, "frame", 1, 1, INT32_MAX);
    if (!frame) co_return tl::unexpected(frame.error());
    const auto limit = number_of(asked.arguments, "timeout_ms", 10'000, 0, kMaxWait);
    if (!limit) co_return tl::unexpected(limit.error());
    const auto until = Clock::now() + std::chrono::milliseconds(*limit);
    for (;;) {
        const auto key = wall_.resolve(*target);
        if (!wall_.sessions().contains(target->session)) co_return tl::unexpected(key.error());
        const auto* surface = key ? wall_.find(*key) : nullptr;
        if (surface && surface->swap.shown(static_cast<std::uint32_t>(*frame)))
            co_return Answer{{{"frame", surface->swap.presented()}}, {}};
        if (Clock::now() >= until) {
            co_return refuse(RefusalKind::unavailable, "frame " + std::to_string(*frame) + " was not shown within " +
                                                           std::to_string(*limit) + " ms; the last one is " +
                                                           std::to_string(surface ? surface->swap.presented() : 0));
        }
        co_await changed_.wait(until);
    }
}

asio::awaitable<Outcome<Answer>> OperatorDesk::screenshot(const Asked& asked) {
    const auto tile = text_of(asked.arguments, "tile"), id = text_of(asked.arguments, "id");
    if (!tile) co_return tl::unexpected(tile.error());
    if (!id) co_return tl::unexpected(id.error());
    const auto output = flag_of(asked.arguments, "output", false);
    if (!output) co_return tl::unexpected(output.error());
    SnapshotQuery query{
        .tile = *tile, .target = {}, .output = *output};  // a name of its own: GCC 12 destroys such a temporary twice
    if (!id->empty()) {
        const auto target = Target::parse(*id);
        if (!target) co_return tl::unexpected(target.error());
        query.target = *target;
    }
    const auto place = pictures_.take(asked.who.text(), {wall_.config().quota.person_pictures, "person_pictures"});
    if (!place) co_return tl::unexpected(place.error());
    auto png = co_await snapshots_.take(std::move(query));
    if (!png) co_return tl::unexpected(png.error());
    co_return Answer{{{"bytes", (*png)->size()}}, std::move(*png)};
}

/// {"kind": what `wallctl pattern` shows, "tile": one; without it all, "output", "bit", "axis", "inverted"}
asio::awaitable<Outcome<Answer>> OperatorDesk::pattern(const Asked& asked) {
    const auto told = pattern_of(asked.arguments);
    if (!told) co_return tl::unexpected(told.error());
    const auto only = text_of(asked.arguments, "tile");
    if (!only) co_return tl::unexpected(only.error());
    std::size_t shown = 0;
    for (const NodeIndex node : wall_.nodes().ids()) {
        const auto config = wall_.nodes()[node].config;
        for (const auto& tile : config->tiles) {
            if (tile.arriving || (!only->empty() && tile.name != *only)) continue;
            auto pattern = *told;
            if (pattern.kind() == proto::TilePattern::NAMES) add_label(pattern, *config, tile);
            if (auto set = wall_.set_pattern(tile.name, pattern); !set) co_return tl::unexpected(set.error());
            ++shown;
        }
    }
    if (shown == 0) co_return refuse(RefusalKind::not_found, "there is no tile '" + *only + "'");
    co_return Answer{{{"tiles", shown}}, {}};
}

// ---- layouts ----

asio::awaitable<Outcome<Answer>> OperatorDesk::layouts(const Asked&) {
    co_return layouts_.list().map([](const std::vector<std::string>& names) { return Answer{names, {}}; });
}

asio::awaitable<Outcome<Answer>> OperatorDesk::layout(const Asked& asked) {
    co_return name_of(asked)
        .and_then([&](const std::string& name) { return layouts_.load(name); })
        .map([](const Layout& layout) {
            return Answer{layout_json(layout), {}};
        });
}

asio::awaitable<Outcome<Answer>> OperatorDesk::save_layout(const Asked& asked) {
    const auto layout = wall_.current_layout();
    co_return name_of(asked).and_then([&](const std::string& name) { return layouts_.save(name, layout); }).map([&] {
        return Answer{{{"windows", layout.windows.size()}}, {}};
    });
}

asio::awaitable<Outcome<Answer>> OperatorDesk::load_layout(const Asked& asked) {
    co_return name_of(asked)
        .and_then([&](const std::string& name) { return layouts_.load(name); })
        .map([&](const Layout& layout) {
            const auto placed = wall_.load_layout(layout);
            return Answer{{{"placed", placed}, {"waiting", layout.windows.size() - placed}}, {}};
        });
}

asio::awaitable<Outcome<Answer>> OperatorDesk::delete_layout(const Asked& asked) {
    co_return name_of(asked).and_then([&](const std::string& name) { return layouts_.remove(name); }).map(done);
}

// ---- machines ----

asio::awaitable<Outcome<Answer>> OperatorDesk::machines(const Asked&) { co_return Answer{machines_.list(), {}}; }

/// The line is a secret: the log has who asked for it, and for whom, but not the line.
asio::awaitable<Outcome<Answer>> OperatorDesk::join_token(const Asked& asked) {
    co_return machines_.invite(asked.arguments, Clock::now()).map([](json line) {
        return Answer{std::move(line), {}};
    });
}

asio::awaitable<Outcome<Answer>> OperatorDesk::revoke(const Asked& asked) {
    co_return machines_.revoke(asked.arguments).map(done);
}

// ---- tokens ----

asio::awaitable<Outcome<Answer>> OperatorDesk::tokens(const Asked&) {
    json out = json::array();
    for (const auto& token : tokens_.all()) {
        const auto programs = std::ranges::count_if(
            wall_.sessions(), [&](const auto& entry) { return entry.second.owner.same_as(token.person); });
        out.push_back({{"name", token.person.name},
                       {"role", config::name_of(token.person.role)},
                       {"revoked", tokens_.is_revoked(token)},
                       {"programs", programs}});
    }
    co_return Answer{std::move(out), {}};
}

/// Its programs end, and whoever watches with it is seen to when they are asked again.
asio::awaitable<Outcome<Answer>> OperatorDesk::revoke_token(const Asked& asked) {
    co_return name_of(asked)
        .and_then([&](const std::string& name) { return tokens_.revoke(name); })
        .map([&](auto gone) {
            std::vector<SessionId> programs;
            for (const auto& [id, session] : wall_.sessions())
                if (session.owner.same_as(gone)) programs.push_back(id);
            for (const SessionId id : programs) end_session_(id, gone.text() + " was revoked by an operator");
            return Answer{{{"ended", programs.size()}}, {}};
        });
}

// ---- what the wall is ----

asio::awaitable<Outcome<Answer>> OperatorDesk::reload(const Asked&) { co_return description_.reload().map(as_answer); }

asio::awaitable<Outcome<Answer>> OperatorDesk::add_node(const Asked& asked) {
    co_return description_.add(asked.arguments).map(as_answer);
}

asio::awaitable<Outcome<Answer>> OperatorDesk::remove_node(const Asked& asked) {
    co_return description_.remove(asked.arguments).map(as_answer);
}

asio::awaitable<Outcome<Answer>> OperatorDesk::drain_node(const Asked& asked) {
    co_return description_.drain(asked.arguments).map(as_answer);
}

asio::awaitable<Outcome<Answer>> OperatorDesk::undrain_node(const Asked& asked) {
    co_return description_.undrain(asked.arguments).map(as_answer);
}

}  // namespace wall::walld
