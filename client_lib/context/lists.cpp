// SPDX-License-Identifier: MIT
#include "client_lib/context/lists.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <list>
#include <mutex>
#include <utility>

#include "client_lib/context/capture_use.h"
#include "client_lib/context/program_use.h"
#include "client_lib/follow/object_sender.h"
#include "client_lib/geometry/block_walk.h"
#include "client_lib/geometry/material.h"
#include "common/glapi/content_hash.h"
#include "common/glstate/diff.h"
#include "common/wire/batch.h"

namespace wall::client {
namespace {

using glapi::Op;
using glapi::Recorded;
using glstate::Category;

/// Ids of runs that are gone and that nodes may still hold. Any thread; never destroyed.
class DeadRuns {
public:
    static DeadRuns& get() {
        static auto* runs = new DeadRuns();
        return *runs;
    }
    void add(std::list<ClientName>& ids) {
        std::lock_guard lock(mutex_);
        ids_.splice(ids_.end(), ids);
        any_.store(true, std::memory_order_release);
    }
    std::list<ClientName> take() {
        if (!any_.load(std::memory_order_acquire)) return {};
        std::lock_guard lock(mutex_);
        any_.store(false, std::memory_order_relaxed);
        return std::exchange(ids_, {});
    }

private:
    std::mutex mutex_;
    std::list<ClientName> ids_;
    std::atomic<bool> any_{false};
};

// ---- drawing a run ----

struct EncodedRun {
    std::uint32_t commands, operand_bytes;
    std::vector<std::byte> content;
};

EncodedRun encoded(const wire::PackBuffer& content) {
    const auto opcodes = content.opcodes(), operands = content.operands();
    std::vector<std::byte> bytes(wire::padded4(opcodes.size()) - opcodes.size());
    bytes.insert(bytes.end(), opcodes.begin(), opcodes.end());
    bytes.insert(bytes.end(), operands.begin(), operands.end());
    return {static_cast<std::uint32_t>(content.commands()), static_cast<std::uint32_t>(content.operand_bytes()),
            std::move(bytes)};
}

/// What a call names (named_objects.h).
struct CalledRun {
    const ListRun& run;
    std::vector<Node*>& reached;

    bool are_on(const Node& node) const {
        const auto known = node.object_stamps.find(run.id);
        return known != node.object_stamps.end() && known->second == run.latest();
    }
    template <class Use>
    void for_each(Use&& use) const {
        use(run);
    }
    void note_on(Node&) const {}
    void note_drawn(Node& node) const { reached.push_back(&node); }
};

void apply_effects(glstate::State& state, const ListRun& run, const ListRun::Effects& effects) {
    const auto before = state.current;
    for (const auto& effect : effects.attributes)
        glstate::apply_attribute(state, effect.op, run.content.operand_at(effect.operand));
    if (!glstate::same(before, state.current)) state.ids.renew(static_cast<std::size_t>(Category::current));
    for (const auto& m : effects.materials) assign_material(state, m.face, m.pname, m.value);
}

/// The nodes that ran it have its effects; the others get the difference when they next need it.
void follow(Context& c, const std::vector<Node*>& nodes, const ListRun& run) {
    std::lock_guard lock(c.session().mutex());
    for (Node* node : nodes) {
        const auto mirror = node->mirrors.find(c.id);
        if (mirror == node->mirrors.end()) continue;
        glstate::State& state = mirror->second.state;
        apply_effects(state, run, run.in_driver);
        unify_id(state, c.state, Category::current);
        if (!run.in_driver.materials.empty()) unify_id(state, c.state, Category::material);
    }
}

Needs needs_of_run(const Context& c, const ListRun& run) {
    if (!run.in_driver.materials.empty()) return {};
    Needs needs = needs_of_geometry(c.state);
    needs.spared |= run.spared;
    return needs;
}

/// About: a vertex of glVertex3f takes 13 bytes, and most have more than that.
double elements_of(const ListRun& run) {
    constexpr double kBytesEach = 24;
    return 1 + static_cast<double>(run.content.bytes()) / kBytesEach;
}

void call_run(Context& c, const ListRun& run) {
    c.flush_block();
    c.determine_modelview_form();
    if (!c.draw_target() || !may_draw(c) || c.draws_nothing) return apply_effects(c.state, run, run.in_context);
    forget_dead_runs(c);
    const Placing& placing = c.placing();
    const bool bounded = placing.of_vertices() && placing.homogeneous;
    draw_in_passes(c.state, *c.captures, [&] {
        std::vector<Node*> reached;
        const bool somewhere = bounded && c.captures->now == nullptr;
        Drawn drawn = somewhere ? Drawn(placing.projection, run.box) : Drawn::anywhere(placing.projection);
        drawn.elements = elements_of(run);
        c.session().draw(c.draw_source(), drawn, needs_of_run(c, run), CalledRun{run, reached},
                         [&](wire::PackBuffer& buffer) { glapi::pack::RunCall(buffer, run.id); });
        follow(c, reached, run);
    });
    apply_effects(c.state, run, run.in_context);
}

// ---- a run within glBegin .. glEnd: unpacked again ----

template <std::size_t N>
std::array<float, N> floats(const std::byte* at) {
    std::array<float, N> values;
    std::memcpy(values.data(), at, sizeof values);
    return values;
}

std::uint32_t word(const std::byte* at) {
    std::uint32_t value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// Calls function(c, f0, f1, ...) with N floats.
template <auto kFunction, std::size_t N>
void play_floats(Context& c, const std::byte* at) {
    std::apply([&](auto... f) { kFunction(c, f...); }, floats<N>(at));
}

void play_vertex_attrib(Context& c, const std::byte* at) {
    const auto f = floats<4>(at + 4);
    api::VertexAttrib4f(c, word(at), f[0], f[1], f[2], f[3]);
}

/// What is more than an attribute: glVertexAttrib may be a vertex.
struct Player {
    Op op;
    void (*play)(Context&, const std::byte*);
};
constexpr Player kPlayers[] = {
    {Op::Begin, [](Context& c, const std::byte* at) { api::Begin(c, word(at)); }},
    {Op::End, [](Context& c, const std::byte*) { api::End(c); }},
    {Op::Vertex2f, play_floats<api::Vertex2f, 2>},
    {Op::Vertex3f, play_floats<api::Vertex3f, 3>},
    {Op::Vertex4f, play_floats<api::Vertex4f, 4>},
    {Op::VertexAttrib4f, play_vertex_attrib},
    {Op::Material,
     [](Context& c, const std::byte* at) { api::Materialfv(c, word(at), word(at + 4), floats<4>(at + 8).data()); }},
    {Op::EvalCoord1f, play_floats<api::EvalCoord1f, 1>},
    {Op::EvalCoord2f, play_floats<api::EvalCoord2f, 2>},
    {Op::EvalPoint1, [](Context& c, const std::byte* at) { api::EvalPoint1(c, static_cast<GLint>(word(at))); }},
    {Op::EvalPoint2,
     [](Context& c, const std::byte* at) {
         api::EvalPoint2(c, static_cast<GLint>(word(at)), static_cast<GLint>(word(at + 4)));
     }},
};

/// An attribute as it stands in the run.
void play_attribute(Context& c, const BlockWalk& walk) {
    const std::size_t bytes = operand_bytes_of(walk.op());
    std::memcpy(c.packer.append_attribute(walk.attribute(), walk.op(), bytes), walk.operand(), bytes);
}

// What was drawn from arrays is one command each, and an error here; a glBegin is an error by itself.
void unpack_run(Context& c, const ListRun& run) {
    BlockWalk walk(run.content, {}, run.content.mark(), {});
    bool refused = false;
    while (walk.next()) {
        if (std::binary_search(run.array_draws.begin(), run.array_draws.end(), walk.position().commands - 1)) {
            c.error(GL_INVALID_OPERATION);
            refused = true;
        }
        if (refused) {
            refused = walk.op() != Op::End;
            continue;
        }
        const auto player =
            std::find_if(std::begin(kPlayers), std::end(kPlayers), [&](const Player& p) { return p.op == walk.op(); });
        if (player != std::end(kPlayers)) player->play(c, walk.operand());
        else if (walk.sets_attribute()) play_attribute(c, walk);
    }
}

void replay_commands(Context& c, std::span<const std::byte> recorded) {
    glapi::for_each_record(recorded, [&](const Recorded& r) { return replay_command(c, r.command, r.payload), true; });
}

}  // namespace

glapi::ListRecorder& Context::list() { return lists->recorder; }

void execute_list(Context& c, const DisplayList& list) {
    for (const ListItem& item : list.items) {
        if (!item.run) replay_commands(c, item.replay);
        else if (c.packer.inside()) unpack_run(c, *item.run);
        else call_run(c, *item.run);
    }
}

void forget_dead_runs(Context& c) {
    const auto dead = DeadRuns::get().take();
    if (dead.empty()) return;
    for (const ClientName id : dead) {
        c.before_change(id);
        c.session().delete_object(c.id, id);
    }
}

// What its end needs is made now.
void ListRun::pack_changes(std::uint64_t, wire::PackBuffer& buffer, const std::function<void()>& packed) const {
    const auto run = encoded(content);
    glapi::pack::RunDefine(buffer, id, run.commands, run.operand_bytes, run.content);
    packed();
}

void ListRun::pack_question(wire::PackBuffer& buffer, RequestId request) const {
    const auto run = encoded(content);
    glapi::ContentHash hash;
    hash.RunDefine(run.commands, run.operand_bytes, run.content);
    glapi::pack::ShareRun(buffer, request, id, hash.finish());
}

ListRun::ListRun() : Object(next_object_id()), obituary_{id} { DeadRuns::get(); }
ListRun::~ListRun() { DeadRuns::get().add(obituary_); }

}  // namespace wall::client
