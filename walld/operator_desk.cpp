// SPDX-License-Identifier: MIT
#include "walld/operator_desk.h"

#include <algorithm>
#include <boost/asio/this_coro.hpp>

#include "walld/status.h"

namespace wall::walld {
namespace {

using nlohmann::json;

constexpr std::chrono::seconds kCloseLimit{3};       // a program that was asked to close and has not is cut off
constexpr std::int64_t kMaxWait = 600'000;           // ms

std::string text_of(const json& arguments, const char* key) {
    const auto found = arguments.find(key);
    if (found == arguments.end()) return {};
    if (found->is_number_integer()) return std::to_string(found->get<std::int64_t>());
    return found->is_string() ? found->get<std::string>() : std::string();
}

Result<Target> target_of(const json& arguments) { return Target::parse(text_of(arguments, "id")); }

std::int64_t number_of(const json& arguments, const char* key, std::int64_t otherwise) {
    const auto found = arguments.find(key);
    return found != arguments.end() && found->is_number_integer() ? found->get<std::int64_t>() : otherwise;
}

}  // namespace

const OperatorDesk::Row OperatorDesk::kVerbs[] = {
    {"status", &OperatorDesk::status}, {"nodes", &OperatorDesk::nodes}, {"tiles", &OperatorDesk::tiles}, {"sessions", &OperatorDesk::sessions},
    {"place", &OperatorDesk::place},   {"raise", &OperatorDesk::raise}, {"lower", &OperatorDesk::lower}, {"close", &OperatorDesk::close},
    {"hold", &OperatorDesk::hold},     {"step", &OperatorDesk::step},   {"wait", &OperatorDesk::wait},   {"screenshot", &OperatorDesk::screenshot},
};

asio::awaitable<proto::OperatorReply> OperatorDesk::answer(proto::OperatorRequest request) {
    const auto arguments = request.json().empty() ? json::object() : json::parse(request.json(), nullptr, false);
    Result<Answer> answer = fail("arguments: expected a JSON object");
    if (arguments.is_object()) answer = co_await run(request.verb(), arguments);
    proto::OperatorReply reply;
    reply.set_request(request.request());
    reply.set_ok(answer.has_value());
    if (answer) {
        reply.set_json(dump(answer->json));
        reply.set_blob(std::move(answer->blob));
    } else {
        reply.set_error(answer.error().message);
    }
    changed_.notify();
    co_return reply;
}

asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::run(const std::string& verb, Arguments arguments) {
    const auto found = std::ranges::find(kVerbs, verb, &Row::name);
    if (found == std::end(kVerbs)) co_return fail("unknown verb '" + verb + "'");
    co_return co_await (this->*found->run)(arguments);
}

asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::status(Arguments) { co_return Answer{status_json(wall_), {}}; }
asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::nodes(Arguments) { co_return Answer{nodes_json(wall_), {}}; }
asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::tiles(Arguments) { co_return Answer{tiles_json(wall_), {}}; }
asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::sessions(Arguments) { co_return Answer{sessions_json(wall_), {}}; }

asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::place(Arguments arguments) {
    const auto side = [&](const char* key) { return static_cast<std::int32_t>(std::clamp<std::int64_t>(number_of(arguments, key, 0), INT32_MIN, INT32_MAX)); };
    co_return target_of(arguments)
        .and_then([&](const Target& target) {
            return wall_.place_surface(target, {side("x"), side("y"), side("width"), side("height")}, Clock::now());
        })
        .map([] { return Answer{}; });
}

asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::raise(Arguments arguments) {
    co_return target_of(arguments).and_then([&](const Target& target) { return wall_.raise(target); }).map([] { return Answer{}; });
}

asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::lower(Arguments arguments) {
    co_return target_of(arguments).and_then([&](const Target& target) { return wall_.lower(target); }).map([] { return Answer{}; });
}

asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::close(Arguments arguments) {
    const auto target = target_of(arguments);
    if (!target) co_return tl::unexpected(target.error());
    if (auto asked = wall_.ask_to_close(*target); !asked) co_return tl::unexpected(asked.error());
    const auto gone = [&] { return !wall_.sessions().contains(target->session) || (target->surface && !wall_.find({target->session, target->surface})); };
    const auto until = Clock::now() + kCloseLimit;
    while (!gone() && Clock::now() < until) co_await changed_.wait(until);
    const bool obeyed = gone();
    if (!obeyed && !target->surface) end_session_(target->session);
    co_return Answer{{{"closed", obeyed ? "by the program" : target->surface ? "not yet" : "by walld"}}, {}};
}

asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::hold(Arguments arguments) {
    const bool on = number_of(arguments, "on", 1) != 0;
    co_return target_of(arguments).and_then([&](const Target& target) { return wall_.hold(target, on, Clock::now()); }).map([] { return Answer{}; });
}

asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::step(Arguments arguments) {
    const auto frames = static_cast<std::uint32_t>(std::clamp<std::int64_t>(number_of(arguments, "frames", 1), 1, INT32_MAX));
    co_return target_of(arguments).and_then([&](const Target& target) { return wall_.step(target, frames, Clock::now()); }).map([] { return Answer{}; });
}

/// Answers when the frame is shown on all tiles. The session may still be about to open its window.
asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::wait(Arguments arguments) {
    const auto target = target_of(arguments);
    if (!target) co_return tl::unexpected(target.error());
    const auto frame = static_cast<std::uint32_t>(std::clamp<std::int64_t>(number_of(arguments, "frame", 1), 1, INT32_MAX));
    const auto limit = std::chrono::milliseconds(std::clamp<std::int64_t>(number_of(arguments, "timeout_ms", 10'000), 0, kMaxWait));
    const auto until = Clock::now() + limit;
    for (;;) {
        if (!wall_.sessions().contains(target->session)) co_return fail("session " + std::to_string(target->session.value) + " has ended");
        const auto key = wall_.resolve(*target);
        const auto* surface = key ? wall_.find(*key) : nullptr;
        if (surface && surface->swap.shown(frame)) co_return Answer{{{"frame", surface->swap.presented()}}, {}};
        if (Clock::now() >= until) {
            co_return fail("frame " + std::to_string(frame) + " was not shown within " + std::to_string(limit.count()) + " ms; the last one is " +
                           std::to_string(surface ? surface->swap.presented() : 0));
        }
        co_await changed_.wait(until);
    }
}

asio::awaitable<Result<OperatorDesk::Answer>> OperatorDesk::screenshot(Arguments arguments) {
    SnapshotQuery query{.tile = text_of(arguments, "tile"), .target = {}};
    if (const auto id = text_of(arguments, "id"); !id.empty()) {
        const auto target = Target::parse(id);
        if (!target) co_return tl::unexpected(target.error());
        query.target = *target;
    }
    auto png = co_await snapshots_.take(std::move(query));
    if (!png) co_return tl::unexpected(png.error());
    co_return Answer{{{"bytes", png->size()}}, std::move(*png)};
}

}  // namespace wall::walld
